// Tests the map of a sweep in Chromium and Firefox, in the studio and in the page of `anholon plot`: node sweeps.mjs
// PROGRAM. Exit status 77: there is no browser, or no viewer.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { browsers } from '../support/browsers.mjs';
import { accessibility, colour_count, studio, watched } from './studio.mjs';

const program = resolve(process.argv[2]);
const skip = (why) => { console.log(`skipped: ${why}`); process.exit(77); };
if (!existsSync('viewer/dist/studio.js')) skip('the viewer is not built');
const started = await browsers();
const folder = mkdtempSync(join(tmpdir(), 'anholon-sweeps-'));
const anholon = (...words) => execFileSync(program, words, { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], env: { ...process.env, ANHOLON_CACHE: '' } }).toString();

anholon('sweep', 'disc', '--vary', "phi'=5:7:8", '--vary', 'theta=0.6:1.2:6', '--to', '2', '--chunk', '12', '--quiet', '-o', 'falls/');
anholon('sweep', 'disc', '--vary', 'm=1:3:9', '--to', '1', '--reduce', 'max(tanh(theta)*exp(-1000*(theta-.3)^2)+psi^2)', '--quiet', '-o', 'line/');
anholon('sweep', 'disc', '--vary', "phi'=4:6:3", '--vary', 'theta=1:1.2:3', '--vary', 'R=0.2:1:4', '--to', '2', '--quiet', '-o', 'several.csv');
anholon('sweep', 'disc', '--vary', 'm~uniform(0.9,1.1)', '--vary', 'theta~uniform(0.9,1.1)', '-n', '300', '--to', '1', '--quiet', '-o', 'drawn.csv');
writeFileSync(join(folder, 'untitled.toml'), 'coordinates = ["x"]\nparticle = [{name = "P", mass = "m", position = "x*ex"}]\nparameters = {m = 1}\ninitial = {"x\'" = 1}\nsimulate = {to = 1}\n');
anholon('sweep', 'untitled.toml', '--vary', 'm=1,2', '--quiet', '-o', 'untitled/');
anholon('plot', 'several.csv', 'x', '-o', 'several.html');
anholon('plot', 'drawn.csv', 'theta', '-o', 'drawn.html');
anholon('plot', 'untitled/', '-o', 'untitled.html');
anholon('plot', 'falls/', '-o', 'plain.html');
anholon('plot', 'falls/', 'theta', '--motions', '6', '-o', 'motions.html');
anholon('plot', 'line/', 'theta', '--motions', '3', '-o', 'line.html');

async function open(browser, address, width = 1280) {
  const opened = await watched(browser, address, width);
  await opened.page.locator('.map canvas').waitFor({ timeout: 30000 });
  return opened;
}
const file = (name) => pathToFileURL(join(folder, name)).href;

// Clicks into the map at (x, y), in parts of its frame.
async function click(page, x, y) {
  const canvas = page.locator('.map canvas'), box = await canvas.boundingBox();
  await canvas.click({ position: { x: 64 + (box.width - 76) * x, y: 8 + (box.height - 52) * y } });
}
const heading = (page) => page.locator('.about h2').innerText();
async function seen(page, draws) {
  await page.locator('.player .play-bar, .player input.scrub').first().waitFor({ timeout: 30000 });
  await page.locator('.plots canvas').first().waitFor({ state: 'attached', timeout: 10000 });     // made when there is nothing else to do
  if (draws) {
    await page.locator('.player').scrollIntoViewIfNeeded();
    await page.waitForFunction(() => (document.querySelector('.player canvas.view')?.width ?? 0) > 0);
    assert.ok(await colour_count(page) > 20, 'the picture is empty');
  }
}
const shows = (page, number) => page.waitForFunction((n) => document.documentElement.dataset.shown === n, String(number), { timeout: 60000 });

const in_studio = {
  async 'a click on a cell shows its motion, and its command is that of the answer'(page, faults, draws) {
    let told = null;
    page.on('response', async (r) => { if (r.url().endsWith('/case')) told = await r.json(); });
    await click(page, .5 / 8, 1 - .5 / 6);
    await shows(page, 0);
    assert.equal(await heading(page), 'Case 0');
    await seen(page, draws);
    await click(page, 7.5 / 8, .5 / 6);
    await shows(page, 47);
    assert.equal(await heading(page), 'Case 47');
    assert.equal(await page.locator('.about pre.command').innerText(), told.command);
    assert.equal(await page.locator('.player').count(), 1);
    assert.match(await page.locator('.status').innerText(), /^motion of case 47 in /);
  },
  async 'a case is chosen by its number, or by arrow keys'(page) {
    await page.getByLabel('Case:').fill('17');
    await page.keyboard.press('Enter');
    await shows(page, 17);
    await page.locator('.map canvas').focus();
    // Six cases stand above each other: the keys move to the neighbours in the picture, and stop at its edge.
    for (const [key, next] of [['ArrowUp', 17], ['ArrowRight', 23], ['ArrowDown', 22], ['ArrowLeft', 16], ['PageDown', 17], ['PageDown', 18]]) {
      await page.keyboard.press(key);
      await shows(page, next);
    }
    assert.equal(await heading(page), 'Case 18');
    assert.equal(await page.getByLabel('Case:').inputValue(), '18');
    await page.getByLabel('Case:').fill('480');
    await page.keyboard.press('Enter');
    await page.locator('.stale').waitFor();
    assert.match(await page.locator('.stale').innerText(), /Shown is case 18\. Case 480: there is no case 480/);
    assert.match(await page.locator('.about').innerText(), /The map shows no case 480\. Its cases have the numbers 0 to 47/);
  },
  async 'the page is as high as the window, and its parts scroll'(page, faults, draws) {
    await click(page, .5 / 8, 1 - .5 / 6);
    await shows(page, 0);
    await seen(page, draws);
    assert.ok(await page.evaluate(() => document.documentElement.scrollHeight <= innerHeight), 'the page scrolls');
  },
  async 'many clicks leave the motion of the last one'(page) {
    for (let k = 0; k < 8; ++k) await click(page, (k + .5) / 8, 1 - .5 / 6);
    await shows(page, 42);
    await page.waitForTimeout(300);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.shown), '42');
    assert.equal(await page.locator('.player').count(), 1);
  },
  async 'a reload shows the parts that have come'(page, faults) {
    const part = join(folder, 'falls/part-000002.parquet'), away = join(folder, 'away');
    renameSync(part, away);
    try {
      await page.reload();
      await page.locator('.growing').waitFor();
      assert.match(await page.locator('.growing').innerText(), /^3 of 4 parts are there/);
      await page.getByLabel('Case:').fill('30');
      await page.keyboard.press('Enter');
      await page.locator('.stale').waitFor();
      assert.match(await page.locator('.stale').innerText(), /There is no motion\. Case 30: the part of case 30 is missing/);
    } finally { renameSync(away, part); }
    await page.reload();
    await page.locator('.map canvas').waitFor();
    assert.equal(await page.locator('.growing').count(), 0);
    faults.splice(0, faults.length, ...faults.filter((f) => !/aborted|cancel/i.test(f)));
  },
};

const in_page = {
  async 'plain.html: a click tells the case'(page) {
    await click(page, .5 / 8, 1 - .5 / 6);
    assert.equal(await heading(page), 'Case 0');
    assert.match(await page.locator('.about pre.command').innerText(), /^anholon report disc --to 2 --qdot phi=5 --q theta=0\.6 -o case-0\.html$/);
    assert.equal(await page.locator('.player').count(), 0);
  },
  async 'several.html: a cell of several cases shows their mean, and a click leads to each of them'(page) {
    const means = await page.evaluate(() => {
      const numbers = (text) => new Float64Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
      const x = numbers(JSON.parse(document.getElementById('data').textContent).columns.find((c) => c.name === 'x').data);
      return Array.from({ length: 9 }, (_, k) => x.slice(4 * k, 4 * k + 4).reduce((a, b) => a + b) / 4);
    });
    const ends = [Math.min(...means), Math.max(...means)].map((mean) => means.indexOf(mean));
    const colours = await page.evaluate((list) => {
      const canvas = document.querySelector('.map canvas'), ratio = devicePixelRatio, w = canvas.clientWidth - 76, h = canvas.clientHeight - 52;
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return list.map((k) => {
        const x = 64 + w * (Math.floor(k / 3) + .5) / 3, y = 8 + h * (1 - (k % 3 + .5) / 3), at = 4 * (Math.round(y * ratio) * canvas.width + Math.round(x * ratio));
        return [...data.slice(at, at + 3)];
      });
    }, ends);
    // The ends of the scale are the least and the greatest mean.
    assert.deepEqual(colours, [[0x44, 0x01, 0x54], [0xfd, 0xe7, 0x25]]);
    await click(page, .5, .5);
    assert.equal(await heading(page), 'Case 16');
    assert.match(await page.locator('.about .place').innerText(), /^4 cases lie in this cell: .*16 17 18 19/);
    assert.ok((await page.locator('.about .note').innerText()).endsWith(`: ${Number(means[4].toPrecision(4))}.`));
    await page.getByRole('button', { name: 'Case 18' }).click();
    assert.equal(await heading(page), 'Case 18');
    await page.getByRole('button', { name: 'The case after' }).click();
    assert.equal(await heading(page), 'Case 19');
    assert.ok(await page.getByRole('button', { name: 'The case after' }).isDisabled());
  },
  async 'drawn.html: a click beside a dot takes the nearest one'(page) {
    const at = await page.evaluate(() => {
      const numbers = (text) => new Float64Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
      const data = JSON.parse(document.getElementById('data').textContent), cells = numbers(data.cells), { clientWidth, clientHeight } = document.querySelector('.map canvas');
      const end = (k, of) => cells.reduce((best, v, n) => (n % 4 === k ? of(best, v) : best), cells[k]);
      const [left, right, low, high] = [end(0, Math.min), end(1, Math.max), end(2, Math.min), end(3, Math.max)];
      const px = (v) => 64 + (clientWidth - 76) * (v - left) / (right - left), py = (v) => 8 + (clientHeight - 52) * (high - v) / (high - low);
      const boxes = Array.from({ length: cells.length / 4 }, (_, k) => [px(cells[4 * k]), py(cells[4 * k + 3]), px(cells[4 * k + 1]), py(cells[4 * k + 2])]);
      const far = ([a, b, c, d], x, y) => Math.hypot(x - (a + c) / 2, y - (b + d) / 2);
      // Finds a place 9 pixels beside a dot, outside of all dots, and nearer to this dot than to others.
      for (const [k, [a, b, c, d]] of boxes.entries()) {
        for (const [dx, dy] of [[0, 9], [9, 0], [0, -9], [-9, 0]]) {
          const x = (a + c) / 2 + dx, y = (b + d) / 2 + dy;
          if (boxes.some((o) => x > o[0] - 1 && x < o[2] + 1 && y > o[1] - 1 && y < o[3] + 1) || boxes.some((o, n) => n !== k && far(o, x, y) < 11)) continue;
          return { x, y, number: numbers(data.columns.find((f) => f.name === 'case').data)[k] };
        }
      }
      return null;
    });
    assert.ok(at, 'no place beside a dot');
    await page.locator('.map canvas').click({ position: { x: at.x, y: at.y } });
    assert.equal(await heading(page), `Case ${at.number}`);
  },
  async 'untitled.html: a model without a title has the name of its file'(page) {
    assert.equal(await page.title(), 'untitled.toml');
    assert.equal(await page.locator('h1').innerText(), 'untitled.toml');
  },
  async 'motions.html: a cell with a motion shows it, another one that next to it'(page, faults, draws) {
    const held = await page.evaluate(() => JSON.parse(document.getElementById('motions').textContent).map((m) => m.number));
    assert.equal(held.length, 6);
    assert.equal(new Set(held).size, 6);
    for (const number of [held[0], held[5]]) {
      await page.getByLabel('Case:').fill(String(number));
      await page.keyboard.press('Enter');
      assert.equal(await heading(page), `Case ${number}`);
      await seen(page, draws);
      assert.equal(await page.locator('.about .note').count(), 0);
    }
    const without = Array.from({ length: 48 }, (_, k) => k).find((k) => !held.includes(k));
    await click(page, (Math.floor(without / 6) + .5) / 8, 1 - (without % 6 + .5) / 6);
    assert.match(await page.locator('.about .note').innerText(), new RegExp(`no motion of case ${without}; that of case \\d+ is next to it`));
    const next = Number((await heading(page)).replace('Case ', ''));
    assert.ok(held.includes(next));
    assert.equal(await page.locator('.player').count(), 1);
    await page.locator('.map canvas').focus();
    await page.keyboard.press('ArrowRight');
    assert.ok(held.includes(Number((await heading(page)).replace('Case ', ''))));
  },
  async 'line.html: one variation, and the outcome is told'(page, faults, draws) {
    const held = await page.evaluate(() => JSON.parse(document.getElementById('motions').textContent).map((m) => m.number));
    assert.deepEqual(held, [1, 4, 7]);
    await page.getByLabel('Case:').fill('4');
    await page.keyboard.press('Enter');
    await seen(page, draws);
  },
};

async function usable(browser, address, motion) {
  for (const width of [1280, 375]) {
    const { page, faults } = await open(browser, address, width);
    await page.getByLabel('Case:').fill('0');
    await page.keyboard.press('Enter');
    if (motion) await page.locator('.player input.scrub').waitFor({ timeout: 60000 });
    assert.deepEqual(await accessibility(page), [], `${address} at a width of ${width}`);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${address} scrolls sideways at a width of ${width}`);
    assert.deepEqual(faults, []);
    await page.close();
  }
}

let failed = 0;
async function attempt(name, test) {
  try { await test(); console.log(`ok: ${name}`); } catch (e) { ++failed; console.log(`FAULT ${name}: ${e.stack ?? e}`); }
}
async function run_tests({ name: of, browser }) {
  const s = await studio(program, 'falls', folder);
  for (const [name, test] of Object.entries(in_studio)) {
    await attempt(`${of}, studio: ${name}`, async () => {
      const { page, faults, draws } = await open(browser, s.address);
      await test(page, faults, draws);
      assert.deepEqual(faults, []);
      await page.close();
    });
  }
  await attempt(`${of}: the studio with a reader of screens, and on a phone`, () => usable(browser, s.address, true));
  assert.equal(await s.end(), 0);
  for (const [name, test] of Object.entries(in_page)) {
    const [html] = name.split(':');
    await attempt(`${of}, ${name}`, async () => {
      const { page, faults, draws } = await open(browser, file(html));
      await test(page, faults, draws);
      assert.deepEqual(faults, []);
      await page.close();
    });
    await attempt(`${of}: ${html} with a reader of screens, and on a phone`, () => usable(browser, file(html), ['motions.html', 'line.html'].includes(html)));
  }
  await browser.close();
}
for (const one of started) await run_tests(one);
rmSync(folder, { recursive: true, force: true });
process.exit(failed > 0 ? 1 : 0);
