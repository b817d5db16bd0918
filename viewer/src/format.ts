// Numbers as text.

// Returns a number with all digits that are needed to read the same double back.
export function exact(x: number): string {
  if (Number.isNaN(x)) return 'no value';
  return Number.isFinite(x) ? String(Object.is(x, -0) ? '-0' : x) : x > 0 ? 'infinite' : '-infinite';
}

// Returns the number of decimals of times in a run of this duration: about a thousand steps from start to end.
export function time_decimals(duration: number): number {
  return duration > 0 ? Math.max(0, Math.min(12, Math.ceil(-Math.log10(duration / 1000)))) : 0;
}

export function fixed(x: number, decimals: number): string {
  const text = x.toFixed(decimals);
  return Number(text) === 0 ? text.replace('-', '') : text;
}

export function with_unit(text: string, unit: string): string { return unit ? `${text}\u00a0${unit}` : text; }

export function short(x: number): string { return String(Number(x.toPrecision(3))); }

// Returns the least number 1, 2 or 5 times a power of ten that is at least x.
export function nice(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  const m = x / power;
  return (m <= 1 ? 1 : m <= 2 ? 2 : m <= 5 ? 5 : 10) * power;
}
