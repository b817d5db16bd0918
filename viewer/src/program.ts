// The straight-line program of a scene (CONTRACT.md): slot i is the value of entry i, which reads earlier slots only.

export type Entry = [string, ...unknown[]];

const functions: Record<string, (x: number) => number> = {
  sin: Math.sin, cos: Math.cos, tan: Math.tan, asin: Math.asin, acos: Math.acos, atan: Math.atan,
  sinh: Math.sinh, cosh: Math.cosh, tanh: Math.tanh, asinh: Math.asinh, acosh: Math.acosh, atanh: Math.atanh,
  exp: Math.exp, log: Math.log, sqrt: Math.sqrt, cbrt: Math.cbrt, abs: Math.abs, sign: Math.sign,
};

type Step = (slots: Float64Array, inputs: Float64Array) => number;

export interface Program {
  size: number;
  run(inputs: Float64Array, slots: Float64Array): void;
}

export function compile(code: Entry[], input_count: number): Program {
  const steps = code.map((entry, k) => step_of(entry, k, input_count));
  return {
    size: steps.length,
    run(inputs, slots) {
      for (let k = 0; k < steps.length; ++k) slots[k] = steps[k](slots, inputs);
    },
  };
}

function step_of(entry: Entry, k: number, input_count: number): Step {
  const wrong = (what: string): never => { throw new Error(`entry ${k} of the scene, ${JSON.stringify(entry)}: ${what}`); };
  const slot = (x: unknown): number =>
    Number.isInteger(x) && (x as number) >= 0 && (x as number) < k ? (x as number) : wrong(`${x} is no earlier slot`);
  const number = (x: unknown): number => (typeof x === 'number' ? x : wrong(`${x} is no number`));
  const list = (x: unknown): number[] => (Array.isArray(x) ? x.map(number) : wrong(`${x} is no list`));
  switch (entry[0]) {
    case 'c': { const c = number(entry[1]); return () => c; }
    case 'i': {
      const i = number(entry[1]);
      if (!(i >= 0 && i < input_count)) wrong(`there are ${input_count} inputs`);
      return (_, inputs) => inputs[i];
    }
    case 'l': {
      const c0 = number(entry[1]), coefficients: number[] = [], terms: number[] = [];
      for (let j = 2; j < entry.length; j += 2) { coefficients.push(number(entry[j])); terms.push(slot(entry[j + 1])); }
      return (v) => {
        let sum = c0;
        for (let j = 0; j < terms.length; ++j) sum += coefficients[j] * v[terms[j]];
        return sum;
      };
    }
    case '*': { const a = slot(entry[1]), b = slot(entry[2]); return (v) => v[a] * v[b]; }
    case '/': { const a = slot(entry[1]), b = slot(entry[2]); return (v) => v[a] / v[b]; }
    case '^': { const a = slot(entry[1]), e = number(entry[2]); return (v) => Math.pow(v[a], e); }
    case 'atan2': { const a = slot(entry[1]), b = slot(entry[2]); return (v) => Math.atan2(v[a], v[b]); }
    case '?': {
      const c = slot(entry[1]), a = slot(entry[2]), b = slot(entry[3]);
      return (v) => (v[c] >= 0 ? v[a] : v[b]);
    }
    case 's': {
      const a = slot(entry[1]), knots = list(entry[2]), values = list(entry[3]);
      if (values.length !== knots.length + 1) wrong('a step function has one value more than knots');
      return (v) => {
        const x = v[a];
        if (Number.isNaN(x)) return NaN;
        let n = 0;
        while (n < knots.length && knots[n] <= x) ++n;
        return values[n];
      };
    }
    case 'f': {
      const f = Object.hasOwn(functions, String(entry[1])) ? functions[String(entry[1])] : wrong('unknown function');
      const a = slot(entry[2]);
      return (v) => f(v[a]);
    }
    default: return wrong('unknown operation');
  }
}
