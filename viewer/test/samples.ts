// Cases as the C++ side would write them, made from formulas whose results are known.

import type { RawCase, RawColumn } from '../src/data.ts';
import type { Entry } from '../src/program.ts';
import type { Item, RawScene } from '../src/scene.ts';

export function encode(values: ArrayLike<number>): string {
  const bytes = new Uint8Array(Float64Array.from(values).buffer);
  let text = '';
  for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return btoa(text);
}

export const range = (n: number, f: (k: number) => number): number[] => Array.from({ length: n }, (_, k) => f(k));

// A program under construction: every method gives the slot of its result.
export class Code {
  readonly entries: Entry[] = [];
  add(...entry: Entry): number { return this.entries.push(entry) - 1; }
  c(x: number): number { return this.add('c', x); }
  i(k: number): number { return this.add('i', k); }
  f(name: string, a: number): number { return this.add('f', name, a); }
  mul(a: number, b: number): number { return this.add('*', a, b); }
  sum(c0: number, ...terms: number[]): number { return this.add('l', c0, ...terms); }
  // a + factor b, of three components
  along(a: number[], factor: number, b: number[]): [number, number, number] {
    return [0, 1, 2].map((k) => this.sum(0, 1, a[k], factor, b[k])) as [number, number, number];
  }
  // Columns of the product of two rotations given by columns.
  product(a: number[], b: number[]): number[] {
    const out: number[] = [];
    for (let j = 0; j < 3; ++j) {
      for (let i = 0; i < 3; ++i) {
        out.push(this.sum(0, ...[0, 1, 2].flatMap((k) => [1, this.mul(a[3 * k + i], b[3 * j + k])])));
      }
    }
    return out;
  }
  rotz(angle: number): number[] {
    const c = this.f('cos', angle), s = this.f('sin', angle), o = this.c(0), m = this.sum(0, -1, s);
    return [c, s, o, m, c, o, o, o, this.c(1)];
  }
  rotx(angle: number): number[] {
    const c = this.f('cos', angle), s = this.f('sin', angle), o = this.c(0), m = this.sum(0, -1, s);
    return [this.c(1), o, o, o, c, s, o, m, c];
  }
}

const mi = (s: string): string => `<mi>${s}</mi>`;
const prime = '<mo lspace="0" rspace="0">\u2032</mo>';
export const math = (inner: string): string => `<math>${inner}</math>`;

const letters: Record<string, string> = { psi: '\u03c8', theta: '\u03b8', phi: '\u03c6', x: 'x', y: 'y' };

function column(name: string, html: string, unit: string, group: string, data: number[]): RawColumn {
  return { name, html: math(html), unit, group, data: encode(data) };
}

export const no_camera: RawScene['camera'] = { eye: null, target: null, up: [0, 0, 1], flat: false, follow: null };

// The angles of a disc and their derivatives; the contact point moves with -R phi' along the horizontal axis of the disc.
export interface DiscMotion { R: number; psi: Jet; theta: Jet; phi: Jet; contact: (t: number) => [number, number] }
type Jet = (t: number) => [number, number, number];

// Constant lean, spin and precession: the contact runs round a circle.
export const steady: DiscMotion = {
  R: 0.5,
  psi: (t) => [0.8 * t, 0.8, 0], theta: () => [1.1, 0, 0], phi: (t) => [5 * t, 5, 0],
  contact: (t) => [-0.5 * (5 / 0.8) * Math.sin(0.8 * t), 0.5 * (5 / 0.8) * Math.cos(0.8 * t)],
};

export function wobbling(end: number): DiscMotion {
  const psi: Jet = (t) => [0.55 * t + 0.5 * Math.sin(1.3 * t), 0.55 + 0.65 * Math.cos(1.3 * t), -0.845 * Math.sin(1.3 * t)];
  const theta: Jet = (t) => [1.15 + 0.2 * Math.sin(2.6 * t), 0.52 * Math.cos(2.6 * t), -1.352 * Math.sin(2.6 * t)];
  const phi: Jet = (t) => [-4 * t + 0.3 * Math.sin(2.6 * t), -4 + 0.78 * Math.cos(2.6 * t), -2.028 * Math.sin(2.6 * t)];
  const n = 20000, h = end / n, path: [number, number][] = [[0, 0]];
  for (let k = 0; k < n; ++k) {
    const t = (k + 0.5) * h, step = -0.5 * phi(t)[1] * h;
    path.push([path[k][0] + step * Math.cos(psi(t)[0]), path[k][1] + step * Math.sin(psi(t)[0])]);
  }
  return { R: 0.5, psi, theta, phi, contact: (t) => path[Math.round(t / h)] };
}

export function disc(motion: DiscMotion, end: number, rows: number, name = ''): RawCase {
  const { R } = motion;
  const t = range(rows, (k) => (end * k) / (rows - 1));
  const columns: RawColumn[] = [];
  const contact_rate = (s: number): [number, number] => {
    const [psi, dpsi] = motion.psi(s), [, dphi] = motion.phi(s);
    void dpsi;
    return [-R * dphi * Math.cos(psi), -R * dphi * Math.sin(psi)];
  };
  const contact_second = (s: number): [number, number] => {
    const [psi, dpsi] = motion.psi(s), [, dphi, ddphi] = motion.phi(s);
    return [-R * (ddphi * Math.cos(psi) - dphi * dpsi * Math.sin(psi)), -R * (ddphi * Math.sin(psi) + dphi * dpsi * Math.cos(psi))];
  };
  const jets: [string, (s: number) => [number, number, number]][] = [
    ['x', (s) => [motion.contact(s)[0], contact_rate(s)[0], contact_second(s)[0]]],
    ['y', (s) => [motion.contact(s)[1], contact_rate(s)[1], contact_second(s)[1]]],
    ['psi', motion.psi], ['theta', motion.theta], ['phi', motion.phi],
  ];
  ['coordinates', 'velocities', 'accelerations'].forEach((group, k) => jets.forEach(([q, f]) => {
    const angle = q.length > 1, unit = (angle ? ['rad', 'rad/s', 'rad/s^2'] : ['m', 'm/s', 'm/s^2'])[k];
    columns.push(column(q + "'".repeat(k), mi(letters[q]) + prime.repeat(k), unit, group, t.map((s) => f(s)[k])));
  }));
  columns.push(column('lambda.rolling[1]', `<msub>${mi('\u03bb')}<mn>1</mn></msub>`, 'N', 'forces', t.map((s) => 3 * Math.sin(2.6 * s))));
  columns.push(column('lambda.rolling[2]', `<msub>${mi('\u03bb')}<mn>2</mn></msub>`, 'N', 'forces', t.map((s) => 2 * Math.cos(1.3 * s) - 1)));
  columns.push(column('E', mi('E'), 'J', 'energy', t.map((s, k) => 9.81 + 1e-13 * Math.sin(7 * s) * Math.sqrt(k))));
  columns.push(column('residual', `<mrow>${mi('R')}<mo>(</mo><mfrac>${mi('t')}<msub>${mi('t')}<mn>0</mn></msub></mfrac><mo>)</mo></mrow>`, '', 'residuals',
    t.map((s, k) => (k % 97 === 3 ? 0 : 1e-15 * (1.3 + Math.sin(50 * s)) * Math.exp(s / 3)))));

  const code = new Code();
  const [x, y, psi, theta, phi] = range(5, (k) => code.i(k));
  const lean = code.product(code.rotz(psi), code.rotx(theta));
  const contact: [number, number, number] = [x, y, code.c(0)];
  const center = code.along(contact, R, lean.slice(3, 6));
  const axes = code.product(lean, code.rotz(phi));
  const velocity: [number, number, number] = [code.i(5), code.i(6), code.c(0)];
  const reaction: [number, number, number] = [code.i(7), code.i(8), code.c(4.9)];
  const items: Item[] = [
    { name: 'disc', label: 'disc', kind: 'body', shape: 'disc', sizes: [R], position: center, axes, color: null },
    { name: 'contact', label: 'contact', kind: 'point', position: contact },
    { name: 'contact', kind: 'trace', of: 'disc', position: contact },
    { name: 'lean', label: '', kind: 'frame', position: center, axes: lean },
    { name: 'v', kind: 'vector', what: 'velocity', of: 'disc', position: center, vector: velocity },
    { name: 'N', kind: 'vector', what: 'reaction', of: 'disc', position: contact, vector: reaction },
  ];
  return {
    name, rows, shown: rows, t: encode(t), unit: 's', columns,
    groups: [{ id: 'coordinates', title: 'Coordinates', log: false }, { id: 'velocities', title: 'Velocities', log: false },
      { id: 'accelerations', title: 'Accelerations', log: false },
      { id: 'forces', title: 'Multipliers', log: false }, { id: 'energy', title: 'Energy', log: false }, { id: 'residuals', title: 'Residuals', log: true }],
    frames: null, events: [],
    scene: {
      inputs: [...range(5, (k) => k).map((k) => ({ column: k, d1: k + 5, d2: k + 10 })), ...[5, 6, 15, 16].map((k) => ({ column: k, d1: -1, d2: -1 }))],
      code: code.entries, items, observer: null, camera: no_camera, floor: { z: 0 },
    },
  };
}

// A car with a trailer seen from above. At t = 4 it turns its wheel at once: the angular velocity jumps.
export function car(): RawCase {
  const jump = 4, end = 14, per_second = 50;
  const before = range(jump * per_second + 1, (k) => k / per_second), after = range((end - jump) * per_second + 1, (k) => jump + k / per_second);
  const t = [...before, ...after];
  const rate = (s: number, k: number): number => (k < before.length ? 0.4 : -0.75 * Math.cos(0.5 * (s - jump)));
  let x = 0, y = 0, psi = 0.2, beta = 0.1, last = 0;
  const data: number[][] = range(7, () => 0).map(() => []);
  t.forEach((s, k) => {
    for (let n = 0; n < 20; ++n) {
      const h = (s - last) / 20, w = rate(s, k);
      x += h * 1.2 * Math.cos(psi); y += h * 1.2 * Math.sin(psi);
      beta += h * 1.2 * Math.sin(psi - beta);
      psi += h * w;
    }
    last = s;
    [x, y, psi, beta, 1.2 * Math.cos(psi), 1.2 * Math.sin(psi), rate(s, k)].forEach((v, j) => data[j].push(v));
  });
  const names: [string, string, string, string][] = [['x', mi('x'), 'm', 'q'], ['y', mi('y'), 'm', 'q'], ['psi', mi('\u03c8'), 'rad', 'q'], ['beta', mi('\u03b2'), 'rad', 'q'],
    ["x'", mi('x') + prime, 'm/s', 'v'], ["y'", mi('y') + prime, 'm/s', 'v'], ["psi'", mi('\u03c8') + prime, 'rad/s', 'v']];
  const code = new Code();
  const [cx, cy, p, b] = range(4, (k) => code.i(k)), zero = code.c(0);
  const turn = code.rotz(p), trailer = code.rotz(b);
  const rear: [number, number, number] = [cx, cy, zero];
  const hitch = rear, tail = code.along(hitch, -1, trailer.slice(0, 3));
  const wheel = (at: number[], axes: number[], along: number, side: number, name: string): Item =>
    ({ name, kind: 'body', shape: 'box', sizes: [0.3, 0.08, 0.1], position: code.along(code.along(at, along, axes.slice(0, 3)), side, axes.slice(3, 6)), axes });
  const items: Item[] = [
    { name: 'car', label: 'car', kind: 'body', shape: 'box', sizes: [0.9, 0.4, 0.1], position: code.along(rear, 0.35, turn.slice(0, 3)), axes: turn },
    { name: 'trailer', label: 'trailer', kind: 'body', shape: 'box', sizes: [0.6, 0.36, 0.1], position: tail, axes: trailer },
    wheel(rear, turn, 0, 0.25, 'wheel 1'), wheel(rear, turn, 0, -0.25, 'wheel 2'),
    { name: 'bar', kind: 'line', points: [hitch, tail] },
    { name: 'rear', kind: 'trace', of: 'car', position: rear }, { name: 'tail', kind: 'trace', of: 'trailer', position: tail },
    { name: 'velocity', kind: 'vector', what: 'velocity', of: 'car', position: rear, vector: [code.i(4), code.i(5), zero] },
  ];
  return {
    name: 'car with a trailer', rows: t.length, shown: t.length, t: encode(t), unit: 's',
    columns: names.map(([n, html, unit, group], k) => column(n, html, unit, group, data[k])),
    groups: [{ id: 'q', title: 'Coordinates', log: false }, { id: 'v', title: 'Velocities', log: false }], frames: null,
    events: [{ t: jump, name: 'turn_the_wheel' }, { t: 11, name: 'brake' }],
    scene: {
      inputs: [{ column: 0, d1: 4, d2: -1 }, { column: 1, d1: 5, d2: -1 }, { column: 2, d1: 6, d2: -1 }, { column: 3, d1: -1, d2: -1 }, { column: 4 }, { column: 5 }],
      code: code.entries, items, observer: null, camera: { ...no_camera, flat: true }, floor: null,
    },
  };
}

// Plots with fewer rows than the run, each column at its own times; a ball on a turntable, whose observer turns.
export function decimated(columns_count = 24): RawCase {
  const end = 100, frame_times = range(501, (k) => (end * k) / 500);
  const columns: RawColumn[] = [
    { name: 'x', html: math(mi('x')), unit: 'm', group: 'q', data: '', t: '' }, { name: 'y', html: math(mi('y')), unit: 'm', group: 'q', data: '', t: '' },
  ];
  const f = [(s: number) => 1.5 + 0.8 * Math.cos(0.3 * s), (s: number) => 0.8 * Math.sin(0.3 * s)];
  columns.forEach((c, k) => {
    const t = range(2000, (j) => (end * (j + (j % 2) * 0.3 * (k + 1) * 0.5)) / 1999.999).map((s) => Math.min(end, s));
    c.t = encode(t);
    c.data = encode(t.map(f[k]));
  });
  for (let k = 0; k < columns_count; ++k) {
    const t = range(4000, (j) => Math.min(end, Math.max(0, (end * (j + 0.4 * Math.sin(k + j))) / 3999))).sort((a, b) => a - b);
    columns.push({ name: `r.${k}`, html: math(`<msub>${mi('r')}<mn>${k}</mn></msub>`), unit: '', group: k % 2 ? 'residuals' : 'many', t: encode(t),
      data: encode(t.map((s, j) => (k % 2 ? (j % 5 === 0 ? 0 : 1e-16 * (1 + k) * Math.exp(s / 20) * (1.1 + Math.sin(9 * s + k))) : Math.sin(s * (1 + k / 30)) + k / 4)) ) });
  }
  const code = new Code();
  const x = code.i(0), y = code.i(1), spin = code.sum(0, 1.4, code.i(2)), center: [number, number, number] = [x, y, code.c(0.25)];
  const axes = code.product(code.rotz(spin), code.rotx(spin));
  return {
    name: 'ball on a turntable', rows: 1_000_001, shown: 4000, t: encode(range(11, (k) => 10 * k)), unit: 's', columns,
    groups: [{ id: 'q', title: 'Coordinates', log: false }, { id: 'many', title: 'Many columns', log: false }, { id: 'residuals', title: 'Residuals', log: true }],
    frames: { t: encode(frame_times), data: { 0: encode(frame_times.map(f[0])), 1: encode(frame_times.map(f[1])) } }, events: [],
    scene: {
      inputs: [{ column: 0, d1: -1, d2: -1 }, { column: 1, d1: -1, d2: -1 }, { column: -1 }], code: code.entries,
      items: [{ name: 'ball', label: 'ball', kind: 'body', shape: 'ball', sizes: [0.25], position: center, axes },
        { name: 'ball', kind: 'trace', of: 'ball', position: center }],
      observer: { t: encode(frame_times), quaternion: encode(frame_times.flatMap((s) => [Math.cos(0.25 * s), 0, 0, Math.sin(0.25 * s)])), origin: encode(frame_times.flatMap(() => [0, 0, 0])) },
      camera: no_camera, floor: { z: 0 },
    },
  };
}

// One of each shape.
export function shapes(): RawCase {
  const code = new Code(), zero = code.c(0), t = range(61, (k) => k / 10);
  const turn = code.product(code.rotz(code.i(0)), code.rotx(code.c(0.5)));
  const list: [string, number[]][] = [['disc', [0.5]], ['ring', [0.5]], ['cylinder', [0.4, 0.6]], ['torus', [0.35, 0.12]], ['ball', [0.45]], ['shell', [0.45]], ['rod', [1]], ['box', [0.8, 0.5, 0.3]], ['point', []]];
  return {
    name: 'shapes', rows: 61, shown: 61, t: encode(t), unit: '', columns: [column('a', mi('a'), '', 'g', t)], groups: [], frames: null, events: [],
    scene: {
      inputs: [{ column: -1 }], code: code.entries,
      items: list.map(([shape, sizes], k): Item => ({ name: shape, label: shape, kind: 'body', shape, sizes, axes: turn, color: null,
        position: [code.c(1.3 * (k % 4)), code.c(1.4 * Math.floor(k / 4)), code.sum(0.7, 0, zero)] })),
      observer: null, camera: no_camera, floor: { z: 0 },
    },
  };
}

export const hostile_name = '</script><script>window.broken=1</script>"\'&<!--';

export function hostile(): RawCase {
  const t = range(11, (k) => k);
  const code = new Code(), p = code.i(0), o = code.c(0);
  return {
    name: hostile_name, rows: 11, shown: 11, t: encode(t), unit: 's',
    columns: [
      { name: hostile_name, html: `<math><mi onclick="window.broken=1">a</mi><mtext><img src=x onerror="window.broken=1"></mtext></math><script>window.broken=1</script>`, unit: '<b>', group: 'g', data: encode(t) },
      { name: '\u0645\u0631\u062d\u0628\u0627 \u0628\u0627\u0644\u0639\u0627\u0644\u0645', html: '', unit: 'm', group: 'g', data: encode(t.map((s) => (s === 5 ? NaN : -s))) },
      { name: 'very_long_' + 'name_'.repeat(60), html: '', unit: 'kg*m^2/s^3', group: 'g', data: encode(t.map((s) => 1e-300 * s)) },
      { name: 'constructor', html: '', unit: '', group: '__proto__', data: encode(t.map((s) => 1 / 3 + s)) },
    ],
    groups: [{ id: 'g', title: hostile_name, log: false }], frames: null, events: [{ t: 3, name: hostile_name }],
    scene: {
      inputs: [{ column: 0 }], code: code.entries,
      items: [{ name: hostile_name, label: hostile_name, kind: 'body', position: [p, o, o], axes: null },
        { name: 'long', label: 'x'.repeat(300), kind: 'point', position: [o, p, o] }],
      observer: null, camera: no_camera, floor: null,
    },
  };
}
