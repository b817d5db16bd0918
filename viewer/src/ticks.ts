// Labels of axes have as many digits as the distance of the ticks needs. If values differ in late digits only, as those of an
// energy, their common part is subtracted and shown once.

export interface Offset { value: number; text: string }

// Returns the common part of the values; null if plain labels are short enough.
export function offset_of(low: number, high: number): Offset | null {
  const size = Math.max(Math.abs(low), Math.abs(high)), span = high - low;
  if (!(size > 0) || span > 2e-4 * size) return null;
  const digits = Math.min(17, Math.max(1, Math.ceil(Math.log10(size / (span || 1e-15 * size))) - 0));
  const text = String(Number(((low + high) / 2).toPrecision(digits)));
  return { value: Number(text), text };
}

export function tick_labels(values: (number | null)[], step: number, offset: number): string[] {
  const shown = values.map((v) => (v === null ? null : v - offset));
  const size = Math.max(...shown.map((v) => Math.abs(v ?? 0)));
  const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-6));
  const plain = size < 1e5 && digits <= 5;
  return shown.map((v) => {
    if (v === null) return '';
    if (Math.abs(v) < 1e-3 * step) return '0';
    if (plain) return v.toFixed(needed(step, digits)).replace('-', '\u2212');
    const exponent = Math.floor(Math.log10(step) + 1e-9), further = needed(step, -exponent) + exponent;
    const significant = Math.max(0, Math.min(15, Math.ceil(Math.log10(Math.abs(v) / step) - 1e-6) + further));
    return v.toExponential(significant).replace(/(\.\d*?)0+e/, '$1e').replace('.e', 'e').replace('e+', 'e').replace(/-/g, '\u2212');
  });
}

// Returns the number of decimals of a step: a step of 2.5 needs one more than a step of 2.
function needed(step: number, digits: number): number {
  const rest = step * 10 ** digits;
  return Math.abs(rest - Math.round(rest)) > 1e-6 ? digits + 1 : digits;
}

// Distances of ticks in the whole range of doubles. An axis takes the least one that leaves room for the labels.
export const increments: number[] = Array.from({ length: 614 }, (_, k) => k - 306).flatMap((k) => [1, 2, 2.5, 5].map((m) => Number(`${m}e${k}`)));

// Returns the multiples of the distance within an axis. They are counted, as adding a distance may not change a far larger value.
export function multiples(low: number, high: number, step: number): number[] {
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first + 1;
  if (!(count > 0) || count > 1000) return [];
  return Array.from({ length: count }, (_, k) => Number(((first + k) * step).toPrecision(15)) + 0);
}

// Returns the ends of a log axis that contains the values: powers of ten.
export function decades_around(low: number, high: number): [number, number] {
  const from = Math.max(-307, Math.floor(Math.log10(low) + 1e-9)), to = Math.min(308, Math.ceil(Math.log10(high) - 1e-9));
  return [power_of_ten(from), power_of_ten(Math.max(to, from + 1))];
}

// Returns the powers of ten within a log axis.
export function decades(low: number, high: number): number[] {
  const first = Math.ceil(Math.log10(low) - 1e-9), count = Math.floor(Math.log10(high) + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, k) => power_of_ten(first + k));
}

const power_of_ten = (k: number): number => Number(`1e${k}`);

// Returns the splits of a log axis that get labels and lines: powers of ten, as many as fit; null for the others.
export function powers(values: number[], room: number): (number | null)[] {
  const exponent = (v: number): number | null => {
    const k = Math.log10(v);
    return Math.abs(k - Math.round(k)) < 1e-6 ? Math.round(k) : null;
  };
  const exponents = values.map(exponent), count = exponents.filter((k) => k !== null).length;
  const step = [1, 2, 5, 10, 20, 50, 100].find((s) => count / s <= room) ?? 200;
  return values.map((v, i) => (exponents[i] !== null && exponents[i]! % step === 0 ? v : null));
}

export function power_label(v: number | null): string {
  if (v === null || !(v > 0)) return '';
  const k = Math.log10(v), up = '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079';
  if (Math.abs(k - Math.round(k)) > 1e-6) return '';
  return `10${String(Math.round(k)).replace('-', '\u207b').replace(/\d/g, (d) => up[Number(d)])}`;
}

// Returns the position at which a text beside the line at x begins: on the right of the line, or on its left if the text would
// pass the edge, as for the event that ends a motion. Returns null if there is no room after `free`.
export function beside(x: number, width: number, gap: number, free: number, edge: number): number | null {
  const at = x + gap + width + gap / 2 > edge ? x - gap - width : x + gap;
  return at < free ? null : at;
}
