// Tests the page of `anholon studio` in Chromium and Firefox: node page.mjs PROGRAM. Exit status 77: there is no
// browser, or no studio.
import assert from 'node:assert/strict';
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { browsers } from '../support/browsers.mjs';
import { accessibility, colour_count, studio as start_studio, watched } from './studio.mjs';

const program = resolve(process.argv[2]);
const skip = (why) => { console.log(`skipped: ${why}`); process.exit(77); };
if (!existsSync('viewer/dist/studio.js')) skip('the studio is not built');
const started = await browsers();

const folder = mkdtempSync(join(tmpdir(), 'anholon-studio-'));
const studio = async (file, browser) => ({ ...await start_studio(program, file), browser });
async function open({ address, browser }, width = 1280) {
  const opened = await watched(browser, address, width);
  await opened.page.waitForFunction(() => document.documentElement.dataset.done, null, { timeout: 90000 });
  return opened;
}

const editor = (page) => page.locator('.cm-content');
// Replaces a text of the model by another one, as if it was typed at once. Returns the time until the new picture is
// drawn.
async function edit(page, from, to) {
  return page.evaluate(async ([a, b]) => {
    const content = document.querySelector('.cm-content'), { view } = content.cmTile ?? content.cmView.rootView ?? content.cmView;
    const at = view.state.doc.toString().indexOf(a);
    if (at < 0) throw new Error(`the model does not hold ${a}`);
    const root = document.documentElement, before = root.dataset.shown, began = performance.now(), end = began + 30000;
    view.dispatch({ changes: { from: at, to: at + a.length, insert: b } });
    while (root.dataset.shown === before && performance.now() < end) await new Promise((next) => setTimeout(next, 1));
    await new Promise((next) => requestAnimationFrame(() => requestAnimationFrame(next)));
    return performance.now() - began;
  }, [from, to]);
}
const until = async (page, what) => { for (let k = 0; k < 400 && !what(); ++k) await page.waitForTimeout(50); assert.ok(what()); };
const tests = {
  async 'a model is shown: picture, plots, equations, proof'(s) {
    const { page, faults, draws } = await open(s);
    if (draws) assert.ok(await colour_count(page) > 20, 'the picture is empty');
    else console.log('no WebGL: pictures are not tested');
    for (const id of ['motion', 'equations', 'proof', 'report']) assert.equal(await page.locator(`#${id}`).count(), 1, id);
    assert.ok(await page.locator('#equations math').count() > 5);
    assert.equal(await page.locator('.problems li').count(), 0);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'a mistake is marked in its line while the last picture stays; corrected it goes'(s) {
    const { page, faults, draws } = await open(s);
    await edit(page, 'm = 1', 'm = "nonsense"');
    await page.locator('.problems li.error').first().waitFor();
    assert.ok(await page.locator('.stale').isVisible());
    assert.ok(await page.locator('.cm-lintRange-error, .cm-lint-marker-error').count() > 0);
    if (draws) assert.equal(await page.locator('.player canvas.view').count(), 1);
    await page.locator('.problems button').first().click();
    assert.ok(await page.evaluate(() => document.activeElement.classList.contains('cm-content')));
    await edit(page, 'm = "nonsense"', 'm = 2');
    await page.locator('.stale').waitFor({ state: 'hidden' });
    await page.waitForFunction(() => document.querySelectorAll('.problems li').length === 0);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'a case of the model can be chosen'(s) {
    const { page, faults } = await open(s);
    assert.ok(await page.locator('.studio-bar select').isHidden());
    await edit(page, 'title = "', 'case.moon.parameters.g = 1.62\ntitle = "');
    const select = page.getByLabel('case');
    await select.waitFor();
    const text = () => page.locator('#report').textContent();
    const choose = async (name) => {
      const before = await page.evaluate(() => { const { dataset } = document.documentElement, { shown } = dataset; delete dataset.shown; return shown; });
      await select.selectOption(name);
      await page.waitForFunction((b) => (document.documentElement.dataset.shown ?? b) !== b, before);
      return text();
    };
    const alone = await text(), moon = await choose('moon');
    assert.notEqual(moon, alone);
    assert.equal(await select.locator('option:checked').innerText(), 'moon');
    assert.equal(await choose('none'), alone);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'completion offers sections, keys, functions and the names of the model'(s) {
    const { page, faults } = await open(s);
    // Types and waits until the word is in the list of completions, which may open before all is typed.
    const offers = async (typed, word) => {
      await editor(page).focus();
      await page.keyboard.press('Control+End');
      await page.keyboard.type(typed, { delay: 15 });
      await page.locator('.cm-tooltip-autocomplete li .cm-completionLabel').getByText(word, { exact: true }).first().waitFor();
      await page.keyboard.press('Escape');
    };
    await offers('\n[[bo', 'body');
    await page.keyboard.type('dy]]');
    await offers('\niner', 'inertia');
    await page.keyboard.type('tia = "');
    await offers('the', 'theta');
    await offers('ta*co', 'cos');
    assert.deepEqual(faults, []);
    await page.close({ runBeforeUnload: false });
  },
  async 'text of a model is shown as text'(s) {
    const { page, faults } = await open(s);
    await edit(page, 'title = "', 'title = "<img src=x onerror=window.harm=1><script>window.harm=1</script>');
    await page.waitForTimeout(300);
    assert.equal(await page.evaluate(() => window.harm), undefined);
    assert.equal(await page.locator('.shown img, .shown script, .problems img').count(), 0);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'Ctrl-S saves to the file that was opened'(s, file) {
    const { page, faults } = await open(s);
    await edit(page, 'title = "', 'title = "Saved: ');
    await editor(page).focus();
    await page.keyboard.press('Control+s');
    // The status may report the motion of the edit instead, so the test reads the file.
    for (let k = 0; k < 400 && !readFileSync(file, 'utf8').startsWith('title = "Saved: '); ++k) await page.waitForTimeout(50);
    assert.match(readFileSync(file, 'utf8'), /^title = "Saved: /);
    writeFileSync(file, '# another program\n');
    await edit(page, 'Saved: ', 'Twice: ');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    await page.getByRole('button', { name: 'Save over it' }).click();
    await page.waitForFunction(() => document.querySelector('.status').textContent === 'saved');
    assert.match(readFileSync(file, 'utf8'), /^title = "Twice: /);
    assert.deepEqual(faults.filter((f) => !f.includes('409')), []);
    await page.close();
  },
  async 'a reload shows the saved text, and a second tab asks before it saves over it'(s, file) {
    const { page, faults } = await open(s), second = await open(s);
    await edit(page, 'title = "', 'title = "First: ');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    await until(page, () => readFileSync(file, 'utf8').startsWith('title = "First: '));
    await page.waitForFunction(() => !document.querySelector('.studio-bar button.due'));
    await page.reload();
    await page.waitForFunction(() => document.querySelector('.cm-content')?.textContent.startsWith('title = "First: '));
    await edit(second.page, 'title = "', 'title = "Second: ');
    await second.page.getByRole('button', { name: 'Save', exact: true }).click();
    const over = second.page.getByRole('button', { name: 'Save over it' });
    await over.waitFor();
    assert.match(readFileSync(file, 'utf8'), /^title = "First: /);
    await over.click();
    await until(page, () => readFileSync(file, 'utf8').startsWith('title = "Second: '));
    assert.deepEqual([...faults, ...second.faults].filter((f) => !f.includes('409') && !/aborted|cancel/i.test(f)), []);
    await page.close();
    await second.page.close();
  },
  async 'a chosen case that the text loses is told with the way out'(s) {
    const { page, faults } = await open(s);
    await edit(page, 'title = "', 'case.moon.parameters.g = 1.62\ntitle = "');
    await page.getByLabel('case').selectOption('moon');
    await edit(page, 'case.moon.', 'case.mars.');
    const told = page.locator('.problems li.error').first();
    await told.waitFor();
    assert.match(await told.innerText(), /there is no case 'moon'.*choose none or another case beside the name of the file/s);
    await page.getByLabel('case').selectOption('');
    await page.waitForFunction(() => document.querySelectorAll('.problems li').length === 0);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'a text that is too long is told as one'(s) {
    const { page } = await open(s);
    await edit(page, 'title = "', `# ${'x'.repeat(1 << 20)}\ntitle = "`);
    await page.waitForFunction(() => document.querySelector('.problems li')?.textContent.startsWith('the text is longer than 1024 KiB'));
    await page.close({ runBeforeUnload: false });
  },
  async 'the page is as high as the window, and its parts scroll'(s) {
    for (const width of [1280, 900]) {
      const { page, faults } = await open(s, width);
      assert.ok(await page.evaluate(() => document.documentElement.scrollHeight <= innerHeight), 'the page scrolls');
      assert.deepEqual(faults, []);
      await page.close();
    }
  },
  async 'many edits leave one picture, and the time of the motion stays'(s) {
    const { page, faults, draws } = await open(s);
    await page.evaluate(() => { const bar = document.querySelector('input.scrub'); bar.value = bar.max; bar.dispatchEvent(new Event('input', { bubbles: true })); });
    const time = await page.locator('.now').innerText();
    for (let k = 0; k < 20; ++k) await edit(page, k === 0 ? 'm = 1' : `m = 1.${k}`, `m = 1.${k + 1}`);
    assert.equal(await page.locator('.player').count(), 1);
    assert.equal(await page.locator('canvas.view').count(), draws ? 1 : 0);
    assert.equal(await page.locator('.now').innerText(), time);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'a new motion is drawn once'(s) {
    const { page, faults, draws } = await open(s);
    await page.evaluate(() => {
      const { prototype } = CanvasRenderingContext2D, draw = prototype.drawImage;
      window.drawn = 0;
      prototype.drawImage = function (...words) { if (this.canvas.classList.contains('view')) ++window.drawn; return draw.apply(this, words); };
    });
    const edits = 3;
    for (let k = 0; k < edits; ++k) {
      await edit(page, k === 0 ? 'm = 1' : `m = 1.${k}`, `m = 1.${k + 1}`);
      await page.waitForFunction(() => document.documentElement.dataset.done === document.documentElement.dataset.shown, null, { timeout: 90000 });
      await page.evaluate(() => new Promise((next) => requestAnimationFrame(() => requestAnimationFrame(next))));
    }
    assert.equal(await page.evaluate(() => window.drawn), draws ? edits : 0);
    assert.deepEqual(faults, []);
    await page.close();
  },
  async 'it can be used with a reader of screens, and on a phone'(s) {
    for (const width of [1280, 390]) {
      const { page } = await open(s, width);
      const found = await accessibility(page);
      assert.deepEqual(found, [], `at a width of ${width}`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'it scrolls sideways');
      await page.close();
    }
  },
};

let failed = 0;
const wanted = process.argv[3] ?? '';
async function run_tests(browser, browser_name) {
  for (const [name, test] of Object.entries(tests)) {
    if (!name.includes(wanted)) continue;
    const file = join(folder, `disc-${browser_name}.toml`);
    copyFileSync('models/zoo/disc.toml', file);
    const s = await studio(file, browser);
    try {
      await test(s, file);
      console.log(`ok in ${browser_name}: ${name}`);
    } catch (e) { ++failed; console.log(`FAULT in ${browser_name}: ${name}: ${e.stack ?? e}`); }
    assert.equal(await s.end(), 0);
  }
}

// Measures the time from an edit to the picture, with a warm program. It is printed only, as the machine may be busy.
async function measure(browser) {
  for (const [model, name] of [['disc', 'm = 1'], ['whipple', 'v = 5']]) {
    const file = join(folder, `${model}.toml`), text = readFileSync(`models/zoo/${model}.toml`, 'utf8');
    writeFileSync(file, text);
    const s = await studio(file, browser), { page } = await open(s);
    const times = [];
    try {
      for (let k = 0; k < 7; ++k) times.push(await edit(page, k === 0 ? name : `${name}.${k}`, `${name}.${k + 1}`));
      times.sort((a, b) => a - b);
      console.log(`${model}: ${(times[3] / 1000).toFixed(2)} s from the edit to the picture, median of 7; ${(times[6] / 1000).toFixed(2)} s at most`);
    } finally { await page.close(); await s.end(); }
  }
}

await Promise.all(started.map(({ name, browser }) => run_tests(browser, name)));
await measure(started[0].browser);
for (const { browser } of started) await browser.close();
rmSync(folder, { recursive: true, force: true });
process.exit(failed > 0 ? 1 : 0);
