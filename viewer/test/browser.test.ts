// The page in a browser, opened from a file. Without Chromium (CHROMIUM, or /usr/bin/chromium) these are skipped.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { chromium, type Browser, type BrowserContextOptions, type Page } from 'playwright-core';
import type { RawCase } from '../src/data.ts';
import { write_page } from './page.ts';
import { car, decimated, disc, encode, hostile, range, shapes, steady, wobbling } from './samples.ts';

const executable = process.env.CHROMIUM ?? '/usr/bin/chromium';
const skip = existsSync(executable) ? false : `no Chromium at ${executable}`;
const args = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--disable-component-update'];
const folder = new URL('../pages/', import.meta.url), dist = new URL('../../dist/', import.meta.url);

let browser: Browser;
before(async () => {
  if (skip) return;
  mkdirSync(folder, { recursive: true });
  browser = await chromium.launch({ executablePath: executable, args });
});
after(async () => { await browser?.close(); });

let count = 0;
interface Opened { page: Page; faults: string[] }

// Any message of the console and any request beyond the file itself is a fault.
async function open(cases: RawCase[], options: BrowserContextOptions & { before?: string; hash?: string } = {}): Promise<Opened> {
  const { before: script = '', hash = '', ...context } = options;
  const address = write_page(new URL(`${++count}.html`, folder), 'A page of the tests', cases, dist, script) + hash;
  const page = await (await browser.newContext({ viewport: { width: 1000, height: 700 }, ...context })).newPage();
  const faults: string[] = [];
  page.on('console', (m) => { if (m.type() === 'error' || m.type() === 'warning') faults.push(m.text()); });
  page.on('pageerror', (e) => faults.push(String(e)));
  page.on('request', (r) => { if (!/^(data|blob):/.test(r.url()) && r.url() !== address.replace(/#.*/, '')) faults.push(`request: ${r.url()}`); });
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.live === '1');
  await page.evaluate(() => window.anholon.ready);
  return { page, faults };
}

// Shares of pixels of a canvas that are drawn at all, and drawn in a strong colour.
const painted = (page: Page, selector: string): Promise<number> => page.evaluate((s) => {
  const canvas = document.querySelector<HTMLCanvasElement>(s)!;
  if (canvas.width === 0) return 0;
  const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height });
  const pen = copy.getContext('2d', { willReadFrequently: true })!;
  pen.drawImage(canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
  let n = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 60) ++n;
  return (4 * n) / data.length;
}, selector);

// What was asked for is drawn in the next frame; drawing without a graphics card, a frame may take long.
const settled = (page: Page): Promise<void> => page.evaluate(() => new Promise((done) => {
  requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(() => done())));
}));

async function until_painted(page: Page, selector: string): Promise<void> {
  for (let k = 0; k < 100; ++k) {
    if (await painted(page, selector) > 0.0005) return;
    await page.waitForTimeout(100);
  }
  assert.fail(`${selector} stays empty`);
}

test('a page opens without faults, shows the first frame and does not play by itself', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 401), car(), decimated(4), shapes()]);
  assert.equal(await page.evaluate(() => window.anholon.cases.length), 4);
  await until_painted(page, '.player canvas.view');
  assert.equal(await page.evaluate(() => window.anholon.cases[0].time), 0);
  assert.equal(await page.locator('.player').first().locator('text=The motion is shown where scripts run').count(), 0);
  assert.equal(await page.locator('.plots .static').first().isVisible(), false);
  for (let k = 0; k < 4; ++k) {
    await page.locator(`.player[data-case="${k}"]`).scrollIntoViewIfNeeded();
    await until_painted(page, `.player[data-case="${k}"] canvas.view`);
  }
  assert.deepEqual(faults, []);
});

test('playing advances time, by button and by key, and stops at the end', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 401)]);
  await until_painted(page, '.player canvas.view');
  const time = (): Promise<number> => page.evaluate(() => window.anholon.cases[0].time);
  await page.getByRole('button', { name: 'Play' }).click();
  await page.waitForFunction(() => window.anholon.cases[0].time > 0.3);
  await page.getByRole('button', { name: 'Pause' }).click();
  const rest = await time();
  await page.waitForTimeout(200);
  assert.equal(await time(), rest);
  await page.locator('canvas.view').focus();
  await page.keyboard.press(' ');
  await page.waitForFunction((t) => window.anholon.cases[0].time > t, rest);
  await page.evaluate(() => { window.anholon.cases[0].pause(); window.anholon.cases[0].seek(9.9); window.anholon.cases[0].play(); });
  await page.waitForFunction(() => window.anholon.cases[0].time === 10);
  await page.getByRole('button', { name: 'Play' }).waitFor();
  assert.deepEqual(faults, []);
});

test('seek and pose: the drawing and the numbers move, and pose agrees with the formula', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 401)]);
  await until_painted(page, '.player canvas.view');
  const picture = (): Promise<string> => page.evaluate(() => document.querySelector<HTMLCanvasElement>('canvas.view')!.toDataURL());
  const first = await picture();
  await page.evaluate(() => window.anholon.cases[0].seek(3.21));
  assert.notEqual(await picture(), first, 'the picture is new when seek returns');
  const pose = await page.evaluate(() => window.anholon.cases[0].pose(3.21).find((p) => p.kind === 'point')!.position);
  const [x, y] = steady.contact(3.21);
  assert.ok(Math.hypot(pose[0] - x, pose[1] - y) < 1e-9);
  assert.match(await page.locator('.now').innerText(), /^3\.21/);
  await page.locator('input.scrub').focus();
  await page.keyboard.press('ArrowRight');
  assert.ok(Math.abs(await page.evaluate(() => window.anholon.cases[0].time) - 3.26) < 1e-12);
  assert.deepEqual(faults, []);
});

test('the camera turns by mouse and keys and resets; nothing is drawn while all is at rest', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 401)]);
  await until_painted(page, '.player canvas.view');
  const picture = (): Promise<string> => page.evaluate(() => document.querySelector<HTMLCanvasElement>('canvas.view')!.toDataURL());
  await settled(page);
  const first = await picture();
  const box = (await page.locator('canvas.view').boundingBox())!;
  await page.mouse.move(box.x + 300, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 420, box.y + 260, { steps: 4 });
  await page.mouse.up();
  await settled(page);
  const turned = await picture();
  assert.notEqual(turned, first);
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('+');
  await settled(page);
  assert.notEqual(await picture(), turned);
  await page.getByRole('button', { name: 'Reset the view' }).click();
  await settled(page);
  assert.equal(await picture(), first);
  const drawings = await page.evaluate(async () => {
    let n = 0;
    const draw = CanvasRenderingContext2D.prototype.drawImage;
    CanvasRenderingContext2D.prototype.drawImage = function (...a: unknown[]) { ++n; return (draw as (...x: unknown[]) => void).apply(this, a); };
    await new Promise((done) => setTimeout(done, 400));
    return n;
  });
  assert.equal(drawings, 0);
  assert.deepEqual(faults, []);
});

test('what is shown can be chosen: toggles, following, both frames', { skip }, async () => {
  const { page, faults } = await open([decimated(2), disc(steady, 10, 201)]);
  await until_painted(page, '.player canvas.view');
  const picture = (k: number): Promise<string> => page.evaluate((i) => document.querySelectorAll<HTMLCanvasElement>('.player')[i].querySelector('canvas')!.toDataURL(), k);
  for (const name of ['Paths', 'Names', 'Grid']) {
    const one = await picture(0);
    await page.locator('.player').first().getByLabel(name).uncheck();
    await settled(page);
    assert.notEqual(await picture(0), one, name);
  }
  await page.getByLabel('Seen by').selectOption('both');
  await page.waitForFunction(() => document.querySelectorAll('.player[data-case="0"] canvas.view').length === 2);
  await until_painted(page, '.player[data-case="0"] .view-box:nth-child(2) canvas');
  const second = page.locator('.player').nth(1);
  await second.scrollIntoViewIfNeeded();
  await until_painted(page, '.player[data-case="1"] canvas.view');
  assert.equal(await second.getByLabel('Length of the arrows').isVisible(), false);
  for (const name of ['Velocities', 'Reactions', 'Axes']) {
    const one = await picture(1);
    await second.getByLabel(name).click();
    await settled(page);
    assert.notEqual(await picture(1), one, name);
  }
  assert.equal(await second.getByLabel('Length of the arrows').isVisible(), true);
  const one = await picture(1);
  await second.getByLabel('Follow').selectOption('disc');
  await settled(page);
  assert.notEqual(await picture(1), one);
  assert.deepEqual(faults, []);
});

test('a scene with floor false has no grid until the reader wants one', { skip }, async () => {
  const bare = disc(steady, 10, 201), lined = disc(steady, 10, 201);
  bare.scene!.floor = false;
  lined.scene!.floor = null;
  const { page, faults } = await open([bare, lined]);
  const picture = async (k: number): Promise<string> => {
    await page.locator('.player').nth(k).scrollIntoViewIfNeeded();
    await until_painted(page, `.player[data-case="${k}"] canvas.view`);
    await settled(page);
    return page.evaluate((i) => document.querySelectorAll<HTMLCanvasElement>('.player')[i].querySelector('canvas')!.toDataURL(), k);
  };
  const without = await picture(0), with_grid = await picture(1);
  assert.notEqual(without, with_grid);
  assert.equal(await page.locator('.player').first().locator('.grid-note').textContent(), '');
  await page.locator('.player').first().getByLabel('Grid').check();
  await settled(page);
  assert.equal(await picture(0), with_grid);
  assert.deepEqual(faults, []);
});

test('the plot reads the stored value under the cursor, in full', { skip }, async () => {
  const raw = disc(wobbling(12), 12, 401);
  const { page, faults } = await open([raw]);
  const plot = page.locator('.plot').nth(1);                     // velocities
  await plot.scrollIntoViewIfNeeded();
  await plot.locator('.u-over').waitFor();
  const box = (await plot.locator('.u-over').boundingBox())!;
  await page.mouse.move(box.x + box.width / 3, box.y + 50);
  await settled(page);
  const row = Math.round(400 / 3), t = (12 * row) / 400;
  assert.equal(await plot.locator('.moment').innerText(), `t = ${t}\u00a0s`);
  const values = await plot.locator('.value').allInnerTexts();
  const stored = await page.evaluate(([r]) => [5, 6, 7, 8, 9].map((k) => {
    const text = atob(JSON.parse(document.getElementById('anholon-data')!.textContent!).cases[0].columns[k].data);
    return new DataView(Uint8Array.from(text, (c) => c.charCodeAt(0)).buffer).getFloat64(8 * r, true);
  }), [row]);
  assert.deepEqual(values.map(Number), stored);
  assert.ok(values.some((v) => v.length >= 16), 'all digits');
  // A click takes the motion there, within a pixel.
  await page.mouse.click(box.x + box.width / 2, box.y + 50);
  assert.ok(Math.abs(await page.evaluate(() => window.anholon.cases[0].time) - 6) < 12 / box.width);
  assert.deepEqual(faults, []);
});

test('a column with times of its own reads its own row', { skip }, async () => {
  const raw = decimated(4);
  const { page, faults } = await open([raw]);
  const plot = page.locator('.plot').nth(0);
  await plot.scrollIntoViewIfNeeded();
  await plot.locator('.u-over').waitFor();
  const box = (await plot.locator('.u-over').boundingBox())!;
  await page.mouse.move(box.x + 0.437 * box.width, box.y + 50);
  await settled(page);
  const read = await plot.locator('.entry').evaluateAll((entries) => entries.map((e) => [e.querySelector('.value')!.textContent!, e.querySelector('.at')!.textContent!]));
  const lead = Number((await plot.locator('.moment').innerText()).replace(/[^\d.e-]/g, ''));
  const expected = await page.evaluate((time) => [0, 1].map((k) => {
    const numbers = (s: string): Float64Array => new Float64Array(Uint8Array.from(atob(s), (c) => c.charCodeAt(0)).buffer);
    const c = JSON.parse(document.getElementById('anholon-data')!.textContent!).cases[0].columns[k];
    const t = numbers(c.t), y = numbers(c.data);
    let best = 0;
    t.forEach((s, i) => { if (Math.abs(s - time) < Math.abs(t[best] - time)) best = i; });
    return [String(y[best]), t[best]];
  }), 43.7);
  assert.ok(Math.abs(lead - 43.7) < 0.15);
  read.forEach(([value, at], k) => {
    assert.equal(value, expected[k][0]);
    if (expected[k][1] !== lead) assert.equal(at, `at ${expected[k][1]} s`);
  });
  assert.deepEqual(faults, []);
});

test('zooming one plot zooms all, a double click goes back, keys move row by row', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 401)]);
  const plot = page.locator('.plot').first();
  await plot.scrollIntoViewIfNeeded();
  await plot.locator('.u-over').waitFor();
  const box = (await plot.locator('.u-over').boundingBox())!;
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 60, { steps: 5 });
  await page.mouse.up();
  const range = (): Promise<number[]> => page.evaluate(() => window.anholon.plots[0]!.range);
  const [from, to] = await range();
  assert.ok(Math.abs(from - 2) < 0.02 && Math.abs(to - 4) < 0.02, `${from} ${to}`);
  assert.equal(await page.evaluate(() => window.anholon.cases[0].time), 0, 'dragging does not seek');
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 40);
  assert.deepEqual(await range(), [0, 10]);
  await page.mouse.move(5, 5);
  await plot.locator('.chart').focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  await settled(page);
  assert.equal(await plot.locator('.moment').innerText(), 't = 0.05\u00a0s');
  await page.keyboard.press('Enter');
  assert.equal(await page.evaluate(() => window.anholon.cases[0].time), 0.05);
  assert.deepEqual(faults, []);
});

test('columns and groups can be hidden; a log axis says what it leaves out; few of many rows are said', { skip }, async () => {
  const { page, faults } = await open([decimated(40)]);
  assert.match(await page.locator('.plots-head .note').innerText(), /^4,000 of 1,000,001 rows are drawn; extremes are kept$/);
  const residuals = page.locator('.plot').nth(2);
  assert.equal(await residuals.locator('.plot > .note, p.note').innerText(), 'exact zeros are not drawn');
  assert.equal(await residuals.locator('.column[aria-pressed="true"]').count(), 8);
  await residuals.getByRole('button', { name: 'show all' }).click();
  assert.equal(await residuals.locator('.column[aria-pressed="true"]').count(), 20);
  await residuals.getByRole('button', { name: 'hide all' }).click();
  assert.equal(await residuals.locator('p.note').innerText(), 'no column is shown');
  await page.getByRole('button', { name: 'Residuals' }).click();
  assert.equal(await residuals.isVisible(), false);
  assert.deepEqual(faults, []);
});

test('axes of residuals near 1e-35 and of a motion that grows without bound have their numbers', { skip }, async () => {
  const raw = disc(steady, 2, 41);
  const column = (name: string, group: string, f: (k: number) => number) => ({ name, html: '', unit: '', group, data: encode(range(41, f)) });
  raw.columns.push(column('residual', 'tiny', (k) => 1e-36 * 10 ** (k / 8)), column('grown', 'huge', (k) => 10 ** (k - 4)));
  raw.groups = [...raw.groups, { id: 'tiny', title: 'Tiny', log: true }, { id: 'huge', title: 'Huge', log: false }];
  const { page, faults } = await open([raw]);
  const drawn = await page.evaluate(async () => {
    const canvases: boolean[] = [];
    for (const title of ['Tiny', 'Huge']) {
      const figure = [...document.querySelectorAll('figure.plot')].find((f) => f.querySelector('.title')!.textContent === title)!;
      figure.scrollIntoView();
      while (!figure.querySelector('canvas')) await new Promise(requestAnimationFrame);
      await new Promise((done) => setTimeout(done, 200));
      const canvas = figure.querySelector('canvas')!, ratio = devicePixelRatio || 1;
      const left = canvas.getContext('2d')!.getImageData(0, 0, 50 * ratio, canvas.height - 35 * ratio).data;      // where labels stand
      canvases.push(left.some((x) => x !== 0));
    }
    return canvases;
  });
  assert.deepEqual(drawn, [true, true]);
  assert.deepEqual(faults, []);
});

test('LaTeX is copied, with and without a clipboard', { skip }, async () => {
  for (const script of ['', 'Object.defineProperty(navigator, "clipboard", { value: undefined });']) {
    const { page, faults } = await open([disc(steady, 10, 11)], { before: script, permissions: ['clipboard-read', 'clipboard-write'] });
    const button = page.getByRole('button', { name: 'Copy LaTeX' });
    await button.focus();
    await page.keyboard.press('Enter');
    await page.locator('.copy-latex.said').waitFor();
    assert.equal(await button.innerText(), 'Copied');
    if (!script) assert.equal(await page.evaluate(() => navigator.clipboard.readText()), '\\dot{x} = -R\\,\\dot{\\varphi}\\cos\\psi');
    assert.deepEqual(faults, []);
  }
});

test('the switch of colours changes page, plots and picture', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 101)], { colorScheme: 'light' });
  await until_painted(page, '.player canvas.view');
  await page.locator('.plot .u-over').first().waitFor();
  const look = (): Promise<string[]> => page.evaluate(() => [getComputedStyle(document.documentElement).backgroundColor,
    document.querySelector<HTMLCanvasElement>('.plot canvas')!.toDataURL(), document.querySelector<HTMLCanvasElement>('canvas.view')!.toDataURL()]);
  await settled(page);
  const light = await look();
  await page.getByRole('button', { name: 'Dark' }).click();
  await settled(page);
  const dark = await look();
  light.forEach((x, k) => assert.notEqual(x, dark[k]));
  await page.getByRole('button', { name: 'As the system' }).click();
  await settled(page);
  assert.equal((await look())[0], light[0]);
  await page.emulateMedia({ colorScheme: 'dark' });
  await settled(page);
  assert.equal((await look())[0], dark[0]);
  assert.deepEqual(faults, []);
});

test('nothing sticks out sideways, wide or narrow', { skip }, async () => {
  for (const cases of [[disc(steady, 10, 101), car()], [decimated(12)], [hostile()]]) {
    const { page, faults } = await open(cases);
    for (const width of [1400, 400, 320]) {
      await page.setViewportSize({ width, height: 900 });
      await page.waitForFunction(() => [...document.querySelectorAll('.chart')].every((c) => {
        const plot = c.querySelector('.u-wrap');
        return plot !== null && Math.abs(plot.clientWidth - c.clientWidth) <= 1;
      }));
      const wide = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth,
        ...[...document.querySelectorAll('.player *, .plots *')].filter((e) => {
          const r = e.getBoundingClientRect();
          return r.width > 1 && r.right > innerWidth + 1 && !e.closest('.unseen, .name, .chip, h2, .u-over, .column');
        }).map((e) => `${e.tagName}.${e.className}`)]);
      assert.deepEqual(wide, [0], `at ${width}`);
    }
    assert.deepEqual(faults, []);
  }
});

test('hostile names stay text', { skip }, async () => {
  const { page, faults } = await open([hostile()]);
  await until_painted(page, '.plot canvas').catch(() => undefined);
  await settled(page);
  assert.equal(await page.evaluate(() => (window as unknown as { broken?: number }).broken), undefined);
  assert.equal(await page.locator('.plots img, .plots [onclick], .plots script').count(), 0);
  assert.deepEqual(await page.evaluate(() => window.anholon.errors), []);
  assert.deepEqual(faults, []);
});

test('brackets stretch with the embedded font', { skip }, async () => {
  const { page } = await open([disc(steady, 10, 11)]);
  const heights = await page.evaluate(() => {
    const bracket = [...document.querySelectorAll('.equation mo')].find((m) => m.textContent === '(')!;
    return [bracket.getBoundingClientRect().height, document.querySelector('.equation mtable')!.getBoundingClientRect().height];
  });
  assert.ok(heights[0] > 0.9 * heights[1], `${heights}`);
});

test('the embedded font has the signs of derivatives and accents that formulas use', { skip }, async () => {
  const { page } = await open([disc(steady, 10, 11)]);
  const missing = await page.evaluate(() => {
    const pen = document.createElement('canvas').getContext('2d')!;
    const width = (sign: string, other: string): number => { pen.font = `40px "Anholon Math", ${other}`; return pen.measureText(sign).width; };
    // A sign that is missing has the width of the font that stands in.
    return [...'\u02d9\u00a8\u2032\u2033\u2034\u00af\u03b8\u2212'].filter((sign) => width(sign, 'monospace') !== width(sign, 'sans-serif'));
  });
  assert.deepEqual(missing, []);
});

test('without WebGL the player says so, and all else works', { skip }, async () => {
  const { page } = await open([disc(steady, 10, 101)], { before: `const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...a) { return /webgl/.test(kind) ? null : get.call(this, kind, ...a); };` });
  assert.match(await page.locator('.player .sorry').innerText(), /WebGL/);
  await page.getByRole('button', { name: 'Play' }).click();
  await page.waitForFunction(() => window.anholon.cases[0].time > 0.1);
  await until_painted(page, '.plot canvas');
});

test('damaged data are said where they would have been shown', { skip }, async () => {
  const raw = disc(steady, 10, 101), bad = disc(steady, 10, 101);
  raw.columns[0].data = 'AAAA';
  bad.scene!.code[3] = ['f', 'nonsense', 0];
  const { page } = await open([raw, bad]);
  assert.match(await page.locator('.plots[data-case="0"]').innerText(), /damaged/);
  assert.match(await page.locator('.player[data-case="1"]').innerText(), /nonsense.*unknown function/);
  assert.equal(await page.locator('.plots[data-case="1"] .plot').count(), 6);
});

test('the stage shows the picture alone', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 101)], { hash: '#stage', viewport: { width: 640, height: 360 } });
  await until_painted(page, 'canvas.view');
  const box = (await page.locator('canvas.view').boundingBox())!;
  assert.deepEqual([box.x, box.y, box.width, box.height], [0, 0, 640, 360]);
  assert.equal(await page.locator('.play-bar').isVisible(), false);
  const one = await page.screenshot();
  await page.evaluate(() => window.anholon.cases[0].seek(5));
  assert.notDeepEqual(await page.screenshot(), one);
  await page.evaluate(() => window.anholon.stage(320, 200));
  await page.waitForTimeout(200);
  const small = (await page.locator('canvas.view').boundingBox())!;
  assert.deepEqual([small.width, small.height], [320, 200]);
  assert.deepEqual(faults, []);
});

test('it prints, light, with every plot and picture', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 101), car()], { colorScheme: 'dark' });
  const pdf = await page.pdf({ format: 'A4', path: new URL('print.pdf', folder).pathname });
  assert.ok(pdf.length > 20000);
  await until_painted(page, '.player[data-case="1"] canvas.view');      // never in sight, drawn for the paper
  assert.deepEqual(faults, []);
});

test('the saved picture is a PNG with the time in its name', { skip }, async () => {
  const { page, faults } = await open([disc(steady, 10, 101, 'a/b c')]);
  await until_painted(page, '.player canvas.view');
  await page.evaluate(() => window.anholon.cases[0].seek(2.5));
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save the picture' }).click()]);
  assert.equal(download.suggestedFilename(), 'a_b_c-t2.50.png');
  assert.deepEqual(faults, []);
});
