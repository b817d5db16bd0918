// What is computed before anything is drawn.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { strips } from '../src/bands.ts';
import { comfortable_rate } from '../src/clock.ts';
import { speed_options } from '../src/controls.ts';
import { rows_within, trace_curve, value_range } from '../src/curve.ts';
import { decode, read_case } from '../src/data.ts';
import { extent, leave_runaways } from '../src/extent.ts';
import { exact, fixed, time_decimals } from '../src/format.ts';
import { interpolate, interval, nearest, type Input } from '../src/interpolate.ts';
import { chain, middle, near } from '../src/lines.ts';
import { compile, type Entry } from '../src/program.ts';
import { place, placement, type Vector } from '../src/rotation.ts';
import { SceneModel, type Item, type Pose } from '../src/scene.ts';
import { beside, decades, decades_around, increments, multiples, offset_of, power_label, powers, tick_labels } from '../src/ticks.ts';
import { car, decimated, disc, encode, range, steady, type DiscMotion } from './samples.ts';

const samples = (t: number[], f: (t: number) => number, d1?: (t: number) => number, d2?: (t: number) => number): Input => ({
  t: Float64Array.from(t), value: Float64Array.from(t.map(f)),
  d1: d1 ? Float64Array.from(t.map(d1)) : null, d2: d2 ? Float64Array.from(t.map(d2)) : null,
});

test('base64 holds little-endian doubles, to the bit', () => {
  // 1.0 = 3ff0 0000 0000 0000, written by hand
  assert.deepEqual([...decode('AAAAAAAA8D8=')], [1]);
  const values = [0, -0, 1 / 3, 5e-324, -1.7976931348623157e308, NaN, Infinity];
  const back = decode(encode(values));
  values.forEach((x, k) => assert.ok(Object.is(back[k], x)));
  assert.throws(() => decode('AAAA'), /no whole number of doubles/);
  const floats = Buffer.from(new Float32Array([1.2, -3e-20, NaN, 0]).buffer).toString('base64');
  assert.deepEqual([...decode(`f:${floats}`)], [1.2, -3e-20, NaN, 0]);
  assert.throws(() => decode('f:AAA='), /no whole number of floats/);
});

test('a case whose column and times differ in length is refused', () => {
  const raw = disc(steady, 1, 11);
  raw.columns[2].data = encode([1, 2, 3]);
  assert.throws(() => read_case(raw), /3 values at 11 times/);
});

test('quintic Hermite reproduces polynomials of degree 5, cubic of degree 3, linear of degree 1', () => {
  const t = [0, 0.7, 1, 2.5], at = range(60, (k) => (2.5 * k) / 59);
  const p = (n: number) => (x: number): number => 1 + x - 2 * x ** n, p1 = (n: number) => (x: number): number => 1 - 2 * n * x ** (n - 1);
  const p2 = (n: number) => (x: number): number => -2 * n * (n - 1) * x ** (n - 2);
  const error = (i: Input, f: (x: number) => number): number => Math.max(...at.map((x) => Math.abs(interpolate(i, x) - f(x))));
  const rounding = 200 * 2.5 ** 6 * 2 ** -52;      // a few operations on values up to 2 * 2.5^6
  assert.ok(error(samples(t, p(5), p1(5), p2(5)), p(5)) < rounding);
  assert.ok(error(samples(t, p(6), p1(6), p2(6)), p(6)) > 0.1, 'degree 6 cannot be met');
  assert.ok(error(samples(t, p(3), p1(3)), p(3)) < rounding);
  assert.ok(error(samples(t, p(4), p1(4)), p(4)) > 0.1);
  assert.ok(error(samples(t, (x) => 3 - x), (x) => 3 - x) < rounding);
  // A derivative without value takes the interpolation down by one degree, not to NaN.
  const gap = samples(t, p(3), p1(3), () => NaN);
  assert.ok(error(gap, p(3)) < rounding);
});

test('stored rows come out bit for bit, and nothing is extrapolated', () => {
  const i = samples([0, 0.1, 0.3], (t) => Math.exp(t) / 3, Math.exp, Math.exp);
  i.t.forEach((t, k) => assert.equal(interpolate(i, t), i.value[k]));
  assert.equal(interpolate(i, -5), i.value[0]);
  assert.equal(interpolate(i, 5), i.value[2]);
  assert.ok(Number.isNaN(interpolate(samples([], () => 0), 1)));
  assert.equal(interpolate(samples([2], () => 7), 1), 7);
});

test('nothing is mixed across a jump', () => {
  const t = [0, 1, 1, 2];
  const i: Input = { t: Float64Array.from(t), value: Float64Array.from([0, 1, 10, 11]), d1: Float64Array.from([1, 1, 1, 1]), d2: null };
  assert.ok(Math.abs(interpolate(i, 0.999999) - 0.999999) < 1e-12);
  assert.equal(interpolate(i, 1), 10);
  assert.equal(interpolate(i, 1, 'before'), 1);
  assert.ok(Math.abs(interpolate(i, 1.000001) - 10.000001) < 1e-12);
  // Jumps at the ends of the run.
  const ends: Input = { t: Float64Array.from([0, 0, 1, 1]), value: Float64Array.from([5, 0, 1, 7]), d1: null, d2: null };
  assert.deepEqual([interpolate(ends, 0, 'before'), interpolate(ends, 0), interpolate(ends, 0.5), interpolate(ends, 1, 'before'), interpolate(ends, 1)], [5, 0, 0.5, 1, 7]);
});

test('interval and nearest row', () => {
  const t = Float64Array.from([0, 1, 1, 2, 4]);
  assert.deepEqual([-1, 0, 0.5, 1, 1.5, 4, 9].map((x) => interval(t, x)), [0, 0, 0, 2, 2, 3, 3]);
  assert.equal(interval(t, 1, 'before'), 0);
  assert.deepEqual([-1, 0.4, 0.6, 0.9999, 1, 1.4, 1.6, 2.9, 3.1, 9].map((x) => nearest(t, x)), [0, 0, 1, 1, 2, 2, 3, 3, 4, 4]);
});

const run = (code: Entry[], ...inputs: number[]): number => {
  const p = compile(code, inputs.length), slots = new Float64Array(p.size);
  p.run(Float64Array.from(inputs), slots);
  return slots[p.size - 1];
};

test('each operation of a program', () => {
  const i: Entry[] = [['i', 0], ['i', 1]];
  const two = (e: Entry, a: number, b: number): number => run([...i, e], a, b);
  assert.equal(two(['c', 2.5], 0, 0), 2.5);
  assert.equal(two(['l', 1, 2, 0, -3, 1], 10, 100), -279);
  assert.equal(two(['*', 0, 1], 3, 7), 21);
  assert.equal(two(['/', 0, 1], 3, 7), 3 / 7);
  assert.equal(two(['^', 0, -1], 4, 0), 0.25);
  assert.equal(two(['^', 0, 0.5], 9, 0), 3);
  assert.equal(two(['atan2', 0, 1], 1, -2), Math.atan2(1, -2));
  assert.deepEqual([-1, 0, 1].map((c) => run([['i', 0], ['c', 5], ['c', 6], ['?', 0, 1, 2]], c)), [6, 5, 5]);
  assert.deepEqual([0, 1, 1.5, 2, 3].map((x) => run([['i', 0], ['s', 0, [1, 2], [10, 20, 30]]], x)), [10, 20, 20, 30, 30]);
  for (const f of ['sin', 'cos', 'tan', 'asin', 'acos', 'atan', 'sinh', 'cosh', 'tanh', 'asinh', 'atanh', 'exp', 'log', 'sqrt', 'abs', 'sign'] as const) {
    assert.equal(run([['i', 0], ['f', f, 0]], 0.3), Math[f](0.3));
  }
  assert.equal(run([['i', 0], ['f', 'acosh', 0]], 1.3), Math.acosh(1.3));
});

test('a program that cannot be right is refused with its entry', () => {
  assert.throws(() => compile([['*', 0, 1]], 0), /entry 0.*no earlier slot/);
  assert.throws(() => compile([['c', 1], ['f', 'gamma', 0]], 0), /entry 1.*gamma.*unknown function/);
  assert.throws(() => compile([['c', 1], ['f', 'constructor', 0]], 0), /unknown function/);
  assert.throws(() => compile([['i', 3]], 2), /there are 2 inputs/);
  assert.throws(() => compile([['what']], 0), /unknown operation/);
});

// The speed of the disc's material point that touches the plane, from poses alone, by central differences.
function slip_speed(model: SceneModel, t: number): number {
  const find = (poses: Pose[], name: string, kind: string): Pose => poses.find((p) => p.name === name && p.kind === kind)!;
  const now = model.pose(t), body = find(now, 'disc', 'body'), contact = find(now, 'contact', 'point');
  const a = body.axes!, d = contact.position.map((x, k) => x - body.position[k]);
  const fixed_to_body = [0, 1, 2].map((j) => d[0] * a[3 * j] + d[1] * a[3 * j + 1] + d[2] * a[3 * j + 2]);
  const where = (s: number): number[] => {
    const b = find(model.pose(s), 'disc', 'body');
    return b.position.map((x, k) => x + [0, 1, 2].reduce((sum, j) => sum + fixed_to_body[j] * b.axes![3 * j + k], 0));
  };
  const h = 1e-4, later = where(t + h), before = where(t - h);       // the cusp's third order: R (phi' h)^3 / 6h = 1e-7 R per second
  return Math.hypot(...later.map((x, k) => (x - before[k]) / (2 * h)));
}

function slip_between_frames(motion: DiscMotion, rows: number, edit: (raw: ReturnType<typeof disc>) => void = () => undefined): number {
  const raw = disc(motion, 10, rows);
  edit(raw);
  const data = read_case(raw), model = new SceneModel(data, raw.scene!);
  let worst = 0;
  for (let k = 1; k < 600; ++k) worst = Math.max(worst, slip_speed(model, k / 60) / 60);
  return worst;
}

test('a rolling disc does not slip between frames by 1e-6 of its radius', () => {
  assert.ok(slip_between_frames(steady, 401) < 1e-6 * steady.R);
  // Mutants: less of the interpolation, and a disc that turns the wrong way.
  const linear = slip_between_frames(steady, 401, (raw) => { for (const i of raw.scene!.inputs) { i.d1 = -1; i.d2 = -1; } });
  assert.ok(linear > 1e-6 * steady.R, `linear interpolation: ${linear}`);
  const wrong = slip_between_frames({ ...steady, contact: (t) => steady.contact(-t) }, 401);
  assert.ok(wrong > 1e-2 * steady.R);
});

test('the disc touches the plane and its axes are a rotation', () => {
  const raw = disc(steady, 10, 401), model = new SceneModel(read_case(raw), raw.scene!);
  for (const t of [0, 1.2345, 9.87]) {
    const body = model.pose(t)[0], a = body.axes!;
    assert.ok(Math.abs(body.position[2] - steady.R * Math.sin(1.1)) < 1e-14);
    const column = (j: number): number[] => a.slice(3 * j, 3 * j + 3), dot = (u: number[], v: number[]): number => u.reduce((s, x, k) => s + x * v[k], 0);
    for (let i = 0; i < 3; ++i) for (let j = 0; j < 3; ++j) assert.ok(Math.abs(dot(column(i), column(j)) - (i === j ? 1 : 0)) < 1e-14);
    const [x, y, z] = [0, 1, 2].map(column);
    assert.ok(Math.abs(x[1] * y[2] - x[2] * y[1] - z[0]) < 1e-14, 'right-handed');
    const [cx, cy] = steady.contact(t), contact = model.pose(t)[1].position;
    assert.ok(Math.hypot(contact[0] - cx, contact[1] - cy) < 1e-9);
  }
});

test('positions and velocities jump at an event only where they do', () => {
  const raw = car(), data = read_case(raw), model = new SceneModel(data, raw.scene!);
  const psi = data.columns.findIndex((c) => c.name === "psi'"), rate = { ...data.animated(psi), d1: null, d2: null };
  assert.ok(Math.abs(interpolate(rate, 4, 'before') - 0.4) < 1e-15);
  assert.ok(Math.abs(interpolate(rate, 4) + 0.75) < 1e-15);
  const before = model.pose(4, 'before')[0].position, after = model.pose(4)[0].position;
  assert.ok(Math.hypot(...before.map((x, k) => x - after[k])) < 1e-12);
  // A path has both sides of the jump.
  assert.equal(model.path_times().filter((p) => p.time === 4).length, 2);
});

test('a case says what is not drawn right, and how many columns it has', () => {
  const raw = car();
  assert.deepEqual([read_case(raw).caution, read_case(raw).rough], ['', false]);
  const rough = read_case({ ...raw, caution: 'too few rows', rough: true, groups: [{ id: 'coordinates', title: 'Coordinates', log: false, columns: 40 }] });
  assert.deepEqual([rough.caution, rough.rough, rough.groups[0].columns], ['too few rows', true, 40]);
});

test('the animation reads its own rows where the plots are decimated', () => {
  const raw = decimated(2), data = read_case(raw), model = new SceneModel(data, raw.scene!);
  assert.equal(data.frames.length, 501);
  const t = 33.4, x = model.pose(t)[0].position[0];
  assert.ok(Math.abs(x - (1.5 + 0.8 * Math.cos(0.3 * t))) < 1e-12, 'a row of frames');
  assert.equal(data.columns[0].t.length, 2000);
  assert.notEqual(data.columns[0].t, data.columns[1].t);
});

test('the observer turns the short way between rows, whatever the sign of its quaternion', () => {
  const angle = (t: number): number => 0.7 * t;
  const q = (t: number, sign: number): number[] => [Math.cos(angle(t) / 2), 0, 0, Math.sin(angle(t) / 2)].map((x) => sign * x);
  const t = Float64Array.from([0, 1, 2]);
  const motion = { t, quaternion: Float64Array.from([...q(0, 1), ...q(1, -1), ...q(2, 1)]), origin: Float64Array.from([0, 0, 0, 1, 0, 0, 2, 0, 0]) };
  for (const s of [0, 0.25, 1, 1.5, 2]) {
    const p = place(placement(motion, s), [1, 0, 5]);
    assert.ok(Math.hypot(p[0] - Math.cos(angle(s)) - s, p[1] - Math.sin(angle(s)), p[2] - 5) < 1e-14);
  }
});

test('curves have gaps where there is no value, at jumps and, on a log axis, at zeros', () => {
  const drawn = (t: number[], y: number[], log = false): string => {
    let text = '';
    trace_curve({ moveTo: (x) => { text += ` M${x}`; }, lineTo: (x) => { text += ` L${x}`; } },
      { name: '', html: '', unit: '', group: '', t: Float64Array.from(t), data: Float64Array.from(y) }, [0, t.length - 1], log, (x) => 100 * x, (v) => v);
    return text.trim();
  };
  assert.equal(drawn([0, 1, 2], [1, 2, 3]), 'M0 L100 L200');
  assert.equal(drawn([0, 1, 2, 3, 4], [1, 1, NaN, 1, 1]), 'M0 L100 M300 L400');
  assert.equal(drawn([0, 1, 1, 2], [1, 1, 5, 5]), 'M0 L100 M100 L200');
  assert.equal(drawn([0, 1, 1, 2], [1, 1, 1, 5]), 'M0 L100 L100 L200');
  assert.equal(drawn([0, 1, 2], [0, 1, -1], true), 'M98.5 L101.5');
  // Of many rows in a pixel the extremes stay.
  const n = 5000, y = range(n, (k) => (k === 2500 ? 9 : k === 2501 ? -9 : 0));
  let high = -Infinity, low = Infinity, count = 0;
  trace_curve({ moveTo: () => undefined, lineTo: (_, v) => { high = Math.max(high, v); low = Math.min(low, v); ++count; } },
    { name: '', html: '', unit: '', group: '', t: Float64Array.from(range(n, (k) => k)), data: Float64Array.from(y) }, [0, n - 1], false, (t) => t / 50, (v) => v);
  assert.deepEqual([high, low], [9, -9]);
  assert.ok(count < 500);
});

test('ranges of what is in view', () => {
  const c = { name: '', html: '', unit: '', group: '', t: Float64Array.from([0, 1, 2, 3]), data: Float64Array.from([5, -1, 0, 2]) };
  assert.deepEqual(value_range([c], 0, 3, false), [-1, 5]);
  assert.deepEqual(value_range([c], 1.5, 2.5, false), [0, 0]);
  assert.deepEqual(value_range([c], 0, 3, true), [2, 5]);
  assert.deepEqual(value_range([c], 2.2, 2.4, false), [0, 2]);
  assert.equal(value_range([], 0, 3, false), null);
  assert.deepEqual(rows_within(c.t, 1, 2), [0, 3]);
});

test('the name of an event stands on the other side of its line at the edge, and where there is room', () => {
  assert.equal(beside(100, 40, 4, -Infinity, 500), 104);
  assert.equal(beside(100, 40, 4, 120, 500), null);
  assert.equal(beside(500, 40, 4, 400, 500), 456);
  assert.equal(beside(500, 40, 4, 460, 500), null);
});

test('axis labels', () => {
  assert.deepEqual(tick_labels([-0.5, 0, 0.5], 0.5, 0), ['\u22120.5', '0', '0.5']);
  assert.deepEqual(tick_labels([2.5, 5, 7.5], 2.5, 0), ['2.5', '5.0', '7.5']);
  assert.deepEqual(tick_labels([20, 40], 20, 0), ['20', '40']);
  assert.deepEqual(tick_labels([0, 1e-12, 2e-12], 1e-12, 0), ['0', '1e\u221212', '2e\u221212']);
  assert.deepEqual(tick_labels([0, 2.5e4, 5e4, 7.5e4, 1e5], 2.5e4, 0), ['0', '2.5e4', '5e4', '7.5e4', '1e5']);
  assert.deepEqual(tick_labels([2.5e-9, 5e-9, 1.25e-8], 2.5e-9, 0), ['2.5e\u22129', '5e\u22129', '1.25e\u22128']);
  assert.deepEqual(tick_labels([9.81, 9.81 + 2 ** -40], 2 ** -40, 9.81)[0], '0');
  assert.equal(offset_of(9.81, 9.81 + 1e-12)?.text, '9.81');
  assert.equal(offset_of(-1, 5), null);
  assert.equal(power_label(1e-13), '10\u207b\u00b9\u00b3');
  assert.equal(power_label(2e-13), '');
  assert.deepEqual(powers([1, 2, 10, 20, 100], 5), [1, null, 10, null, 100]);
  assert.deepEqual(powers(range(21, (k) => 10 ** (k - 20)), 6).filter((v) => v !== null).length, 5);
});

test('numbers read back as the same double', () => {
  for (const x of [0.1 + 0.2, 1e-300, -1 / 3, 123456789.123456789]) assert.equal(Number(exact(x)), x);
  assert.equal(exact(-0), '-0');
  assert.equal(exact(NaN), 'no value');
  assert.equal(time_decimals(10), 2);
  assert.equal(time_decimals(1e-6), 9);
  assert.equal(fixed(-1e-9, 2), '0.00');
});

test('a run takes a comfortable time', () => {
  assert.equal(comfortable_rate(12), 1);
  assert.equal(comfortable_rate(1e-3), 1e-4);
  assert.equal(comfortable_rate(3600), 360);
  assert.equal(comfortable_rate(0), 1);
});

test('a band is cut at the range that is shown', () => {
  const band = { name: 'belt', spans: [[0, 1, 2], [1, 3, 1], [3, 4, 2]] as [number, number, number][] };
  assert.deepEqual(strips(band, 0, 4), [{ x: 0, width: 0.25, mode: 2 }, { x: 0.25, width: 0.5, mode: 1 }, { x: 0.75, width: 0.25, mode: 2 }]);
  assert.deepEqual(strips(band, 2, 2.5), [{ x: 0, width: 1, mode: 1 }]);
  assert.deepEqual(strips(band, 5, 6), []);
});

test('a case without contacts has no bands', () => {
  assert.deepEqual(read_case(disc(steady, 1, 11)).bands, []);
});

test('ticks of axes whose values are far from one', () => {
  assert.deepEqual(multiples(-0.11, 0.32, 0.1), [-0.1, 0, 0.1, 0.2, 0.3]);
  assert.deepEqual(multiples(0, 4.2e36, 1e36), [0, 1e36, 2e36, 3e36, 4e36]);
  assert.deepEqual(multiples(3e-41, 6e-41, 2e-41), [4e-41, 6e-41]);
  assert.deepEqual(multiples(1, 1, 0), []);
  assert.ok(increments.includes(1e36) && increments.includes(2.5e-36) && increments.every((x, k) => k === 0 || x > increments[k - 1]));
  // On a log axis below 1e-24 uPlot's own list never ends.
  assert.deepEqual(decades_around(7.6e-37, 1.5e-31), [1e-37, 1e-30]);
  assert.deepEqual(decades(1e-37, 1e-30).length, 8);
  assert.deepEqual(decades(1e-2, 1e1), [1e-2, 1e-1, 1, 1e1]);
  assert.deepEqual(decades_around(1e-16, 1e-16), [1e-16, 1e-15]);
  assert.ok(decades(...decades_around(5e-324, 1.7e308)).every((x) => x > 0 && Number.isFinite(x)));
});

test('paths keep their digits in single precision, far from the origin', () => {
  const points: [number, number, number][] = [0, 0.25, 0.5].map((x) => [1e9 + x, 0, 6371000 + 2 * x]);
  const origin = middle(points);
  assert.deepEqual(origin, [1e9 + 0.25, 0, 6371000.5]);
  assert.deepEqual([...chain(points, origin)], [-0.25, 0, -0.5, 0, 0, 0, 0, 0, 0, 0.25, 0, 0.5]);
  assert.deepEqual(near(origin, points[2]), [0.25, 0, 0.5]);
  // What grows without bound is left out.
  assert.equal(chain([[0, 0, 0], [1e200, 0, 0], [NaN, 0, 0]], [0, 0, 0]).length, 0);
  assert.deepEqual(middle([[1, 1, 1], [1e200, 0, 0]]), [1, 1, 1]);
});

test('what runs away does not count for the first look', () => {
  const of = (f: (k: number) => number): { at: [number, number, number]; r: number }[] =>
    range(100, f).map((x) => ({ at: [x, 0, 0], r: 0 }));
  const grown = of((k) => 1 / (1 - k / 99.0000001)), even = of((k) => k);
  leave_runaways(grown, 0);
  leave_runaways(even, 0);
  assert.ok(grown.length < 100 && grown.length >= 90);
  assert.equal(even.length, 100);
});

test('speeds are true: 1× is real time for every run', () => {
  assert.deepEqual(speed_options(1, 's').map(([, text]) => text), ['0.1×', '0.2×', '0.5×', '1×', '2×', '5×', '10×']);
  const long = speed_options(60, 's');
  assert.deepEqual(long.map(([, text]) => text), ['1×', '6×', '12×', '30×', '60×', '120×', '300×', '600×']);
  assert.ok(Math.abs(Number(long[0][0]) * 60 - 1) < 1e-12);
  assert.equal(speed_options(60, '').find(([factor]) => factor === '1')![1], '60 per s');
});

test('a page of one row is at its time', () => {
  const raw = disc(steady, 1, 11);
  const at = encode([1]);
  const one = read_case({ ...raw, t: at, rows: 1, shown: 1, frames: null, columns: raw.columns.slice(0, 1).map((c) => ({ ...c, data: at }))
    .concat([{ ...raw.columns[0], name: 'step', t: encode([0.1, 1]), data: encode([0.1, 0.9]) }]), scene: null });
  assert.deepEqual([one.start, one.end], [1, 1]);
});

test('a long chain has an extent', () => {
  const items = Array.from({ length: 1000 }, (_, k) => ({ name: `p${k}`, kind: 'point', position: [0, 0, 0] })) as unknown as Item[];
  const model = {
    items, sample_times: () => range(300, (k) => k), in_frame: (_frame: string, _time: number, v: Vector) => v,
    pose: () => items.map((item, k) => ({ name: item.name, kind: item.kind, axes: null, position: [k, -k, 0] as Vector })),
  } as unknown as SceneModel;
  const found = extent(model, 'observer');
  assert.equal(found.points.length, 300000);
  assert.deepEqual(found.center, [499.5, -499.5, 0]);
});
