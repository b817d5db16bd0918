// Opens pages of real models in a browser from disk: node pages.mjs PROGRAM. Exit status 77: there is no browser, or no
// viewer.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const program = resolve(process.argv[2]);
const browser_path = process.env.CHROMIUM ?? '/usr/bin/chromium';
const skip = (why) => { console.log(`skipped: ${why}`); process.exit(77); };
if (!existsSync(browser_path)) skip(`no ${browser_path}`);
if (!existsSync('viewer/dist/viewer.js')) skip('the viewer is not built');
const { chromium } = await import(resolve('viewer/node_modules/playwright-core/index.mjs')).catch(() => skip('no playwright-core'));

const folder = mkdtempSync(join(tmpdir(), 'anholon-pages-'));
const run = (...args) => execFileSync(program, args, { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], encoding: 'utf8' });
const page_of = (name, ...args) => { run('report', ...args, '-o', `${name}.html`, '--quiet'); return join(folder, `${name}.html`); };

const browser = await chromium.launch({
  executablePath: browser_path,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--disable-component-update'],
});

// Opens a page, which must give no error or warning, make no request, and be no wider than the window.
async function open(path, width) {
  const page = await browser.newPage({ viewport: { width, height: 900 } });
  const faults = [];
  page.on('console', (m) => { if (m.type() === 'error' || m.type() === 'warning') faults.push(m.text()); });
  page.on('pageerror', (e) => faults.push(e.stack ?? e.message));
  page.on('request', (r) => { if (!/^(file|data|blob):/.test(r.url())) faults.push(`asked for ${r.url()}`); });
  await page.goto(`file://${path}`);
  await page.evaluate(() => window.anholon.ready);
  const clipped = await page.evaluate(() => [...document.querySelectorAll('main *')]
    .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest('.wide, .formula, pre, svg, canvas, .u-wrap'))
    .slice(0, 3).map((e) => `${e.tagName}.${e.className}`));
  if (clipped.length) faults.push(`beyond the edge: ${clipped.join(', ')}`);
  const across = await page.evaluate(() => document.documentElement.scrollWidth);
  if (across > width) faults.push(`scrolls sideways: ${across} of ${width}`);
  return { page, faults };
}

// The motion of the material point at the contact between two frames of a screen; `contact` is the name of a point.
async function slip(page, body, contact) {
  return page.evaluate(([b, c]) => {
    const { pose, times } = window.anholon.cases[0];
    const of = (t, name) => pose(t).find((p) => p.name === name && p.position);
    const d = 1e-4;
    let worst = 0;
    for (let k = 1; k < 400; ++k) {
      const t = times.start + (times.end - times.start) * (k + 0.37) / 401;       // never a row of the run
      const here = of(t, b), at = of(t, c).position;
      const arm = at.map((x, i) => x - here.position[i]);
      const own = [0, 1, 2].map((a) => arm.reduce((s, x, i) => s + x * here.axes[3 * a + i], 0));
      const point = (p) => p.position.map((x, i) => x + own.reduce((s, o, a) => s + o * p.axes[3 * a + i], 0));
      const before = point(of(t - d, b)), after = point(of(t + d, b));
      worst = Math.max(worst, Math.hypot(...after.map((x, i) => x - before[i])) / (2 * d) / 60);
    }
    return worst;
  }, [body, contact]);
}

let failed = 0;
async function test(name, body) {
  try {
    await body();
    console.log(`ok: ${name}`);
  } catch (e) {
    ++failed;
    console.log(`FAILED: ${name}\n${e.stack ?? e}`);
  }
}

// Without ANHOLON_LONG=1 only the first few of a list of models: a browser that draws by software takes seconds for each.
const some = (list, count) => (process.env.ANHOLON_LONG ? list : list.slice(0, count));
const figures = some(['luo-zhao-example-2', 'rolling-coin', 'car-three-trailers', 'luo-zhao-example-1', 'snakeboard', 'rattleback', 'ball-on-turntable-rotating'], 3);
for (const model of figures) {
  await test(`${model}: opens at both widths without a fault, and fits`, async () => {
    const path = page_of(model, model, '--no-proof');
    assert.ok(readFileSync(path).length < 1.4e6, 'well under 1.5 MB');
    for (const width of [1400, 400]) {
      const { page, faults } = await open(path, width);
      const boxes = await page.$$eval('.equation math', (list) => list.map((m) => [m.getBoundingClientRect().width, m.getBoundingClientRect().height]).filter(([w]) => w > 0));
      assert.ok(boxes.length > 4);
      for (const [w, h] of boxes) assert.ok(w > 3 && h > 4 && h < 130, `an equation of ${w} x ${h} pixels`);
      assert.deepEqual(faults, []);
      await page.close();
    }
  });
}

const rolling = [['rolling-coin', 'coin', 'contact', 0.5], ['ball-on-turntable-rotating', 'ball', 'contact', 0.25], ['disc', 'disc', 'contact', 0.5]];
for (const [model, body, contact, radius] of some(rolling, 2)) {
  await test(`${model}: rolls in the picture without slipping`, async () => {
    // The view hides some points that the test needs, such as the contact.
    const text = run('models', model).replace(/^hide .*$/m, '');
    writeFileSync(join(folder, `${model}.toml`), text);
    const { page, faults } = await open(page_of(`slip-${model}`, `${model}.toml`, '--no-proof'), 1000);
    const s = await slip(page, body, contact);
    assert.ok(s < 1e-6 * radius, `slips by ${s}`);
    // A point that is not the contact does move.
    assert.ok(await slip(page, body, body) > 1e-4 * radius);
    assert.deepEqual(faults, []);
    await page.close();
  });
}

const ball = `title = "Ball on a floor"
coordinates = ["x", "z"]
parameters = {g = 10, e = 0.5}
particle = [{name = "ball", mass = 1, position = "x*ex + z*ez"}]
gravity.field = "-g*ez"
event = [{name = "bounce", when = "z", direction = "down", set = {"z'" = "-e*z'"}}]
initial = {z = 5, "x'" = 1}
simulate = {to = 2.9, every = 0.3}
`;
await test('what bounces goes through no floor, in rows of the page and in rows of a file', async () => {
  writeFileSync(join(folder, 'ball.toml'), ball);
  run('simulate', 'ball.toml', '-o', 'ball.h5', '--quiet');
  // The rows of the file have two events in their last intervals, where velocities are unknown.
  for (const [name, limit, ...args] of [['ball', 1e-9, 'ball.toml', '--no-proof'], ['ball-rows', 1e-3, 'ball.h5', '--no-proof']]) {
    const { page, faults } = await open(page_of(name, ...args), 1000);
    const least = await page.evaluate(() => {
      const { pose, times } = window.anholon.cases[0];
      return Math.min(...Array.from({ length: 20000 }, (_, k) => pose((times.end * k) / 20000).find((i) => i.kind === 'body').position[2]));
    });
    assert.ok(least > -limit, `${name} is at z = ${least}`);
    assert.deepEqual(faults, []);
    await page.close();
  }
});

await test('play advances the time, a hovered value is the stored one', async () => {
  run('simulate', 'disc', '--to', '2', '--every', '0.01', '-o', 'disc.csv', '--quiet');
  const { page, faults } = await open(page_of('hover', 'disc', '--rows', 'disc.csv', '--no-proof'), 1200);
  const before = await page.evaluate(() => window.anholon.cases[0].time);
  await page.getByRole('button', { name: /play/i }).first().click();
  await page.waitForFunction((t) => window.anholon.cases[0].time > t, before);
  await page.evaluate(() => window.anholon.cases[0].pause());
  const plot = page.locator('.plot').filter({ has: page.locator('.title', { hasText: /^Velocities/ }) }).first();
  await plot.scrollIntoViewIfNeeded();
  await plot.locator('.u-over').waitFor();
  const box = await plot.locator('.u-over').boundingBox();
  await page.mouse.move(box.x + 0.31 * box.width, box.y + 40);
  await page.waitForTimeout(300);
  const t = Number((await plot.locator('.moment').innerText()).replace(/[^\d.e-]/g, ''));
  const values = await plot.locator('.value').allInnerTexts();
  const lines = readFileSync(join(folder, 'disc.csv'), 'utf8').trim().split('\n').map((l) => l.split(','));
  const row = lines.find((l) => l[0] !== 't' && Number(l[0]) === t);
  assert.ok(row, `a row at t = ${t}`);
  // A panel holds the velocities of one dimension.
  const names = await plot.locator('.column').evaluateAll((buttons) => buttons.map((b) => b.title.replace(/ \(.*/, '')));
  assert.ok(names.length > 0 && names.every((n) => /^[a-z]+'$/.test(n)), String(names));
  assert.deepEqual(values, names.map((n) => String(Number(row[lines[0].indexOf(n)]))));
  assert.deepEqual(faults, []);
  await page.close();
});

await test('hostile names are text', async () => {
  const evil = '</script><script>window.hit = 1</script><img src=x onerror="window.hit = 2">';
  const text = run('models', 'chaplygin-sleigh').replace(/^title = .*$/m, `title = ${JSON.stringify(`${evil} "'&\u202eabc\u05d0\u05d1 ${'very '.repeat(80)}`)}`)
    .replace(/^source = .*$/m, `source = ${JSON.stringify(evil)}`).replace(/^(m|M) = 2.*$/m, `m = {value = 2, doc = ${JSON.stringify(evil)}}`);
  assert.ok(text.includes('doc ='));
  writeFileSync(join(folder, 'evil.toml'), text);
  const path = page_of('evil', 'evil.toml');
  for (const width of [1400, 400]) {
    const { page, faults } = await open(path, width);
    assert.equal(await page.evaluate(() => window.hit), undefined);
    assert.equal(await page.locator('main img').count(), 0);
    assert.ok((await page.locator('h1').innerText()).startsWith('</script><script>'));
    assert.deepEqual(faults, []);
    await page.close();
  }
});

await test('the certificate is in the page', async () => {
  const { page, faults } = await open(page_of('proved', 'snakeboard'), 1000);
  const link = page.locator('#proof a[download]');
  assert.equal(await link.getAttribute('download'), 'snakeboard.proof.json');
  const [kind, data] = (await link.getAttribute('href')).split(',');
  assert.equal(kind, 'data:application/json;base64');
  writeFileSync(join(folder, 'snakeboard.proof.json'), Buffer.from(data, 'base64'));
  const said = run('verify', 'snakeboard.proof.json');
  const claims = [...said.matchAll(/(\d+) of (\d+) confirmed/g)].reduce((s, m) => s + Number(m[2]), 0);
  assert.ok(claims > 20);
  assert.ok((await page.locator('#proof').innerText()).includes(`The certificate holds ${claims} claims, all confirmed`));
  assert.deepEqual(faults, []);
  await page.close();
});

await test('scenarios stand side by side', async () => {
  const text = `${run('models', 'chaplygin-sleigh')}\n[case.heavy]\nparameters.m = 20\n[case.light]\nparameters.m = 1\n`;
  writeFileSync(join(folder, 'cases.toml'), text);
  const { page, faults } = await open(page_of('cases', 'cases.toml', '--case', 'heavy', '--case', 'light', '--no-proof'), 1400);
  assert.equal(await page.evaluate(() => window.anholon.cases.length), 2);
  const [a, b] = await page.locator('article.case').all();
  const x = await a.boundingBox(), y = await b.boundingBox();
  assert.ok(Math.abs(x.y - y.y) < 2 && y.x > x.x + 300, 'beside each other');
  assert.deepEqual(faults, []);
  await page.close();
});

await test('the modes of a contact are bands under the plots', async () => {
  for (const model of ['stick-slip', 'disc']) {
    const { page, faults } = await open(page_of(`bands-${model}`, model, '--no-proof'), 1200);
    // The parts of the lower edge of the first plot that have the colours of the modes.
    const colors = await page.evaluate(async () => {
      for (let k = 0; k < 100 && !document.querySelector('.plot canvas'); ++k) await new Promise((f) => setTimeout(f, 50));
      const canvas = document.querySelector('.plot canvas'), over = document.querySelector('.plot .u-over');
      const scale = canvas.width / canvas.getBoundingClientRect().width, box = canvas.getBoundingClientRect(), o = over.getBoundingClientRect();
      const y = Math.round((o.bottom - box.top - 3) * scale), found = {};
      const line = canvas.getContext('2d').getImageData(Math.round((o.left - box.left) * scale), y, Math.round(o.width * scale), 1).data;
      for (let k = 0; k < line.length; k += 4) if (line[k + 3] === 255) (found[`rgb(${line[k]}, ${line[k + 1]}, ${line[k + 2]})`] ??= []).push(k / 4);
      // The part of the line that a dashed band covers; gaps of at most `gap` between its dashes count as covered.
      const part = (at, gap) => at.reduce((sum, x, i) => sum + (i > 0 && x - at[i - 1] <= gap ? x - at[i - 1] : 1), 0) / (line.length / 4);
      const style = (name) => { const e = document.createElement('i'); e.style.color = `var(--${name})`; document.body.append(e); const c = getComputedStyle(e).color; e.remove(); return c; };
      const slips = found[style('c1')] ?? [], sticks = found[style('c2')] ?? [], gap = Math.ceil(6 * scale);
      return { slips: part(slips, gap), dashes: part(slips, 1), sticks: part(sticks, 1) };
    });
    const key = await page.locator('.bands-key').allInnerTexts();
    if (model === 'disc') {
      assert.deepEqual([key.length, colors.slips, colors.sticks], [0, 0, 0], 'a model without contacts');
    } else {
      assert.match(key[0], /Contact belt/);
      // The contact slips from 0.327 to 1.112, from 1.357 to 2.142 and from 2.387 to 3 seconds.
      assert.ok(Math.abs(colors.slips - (0.785 + 0.785 + 0.613) / 3) < 0.02, JSON.stringify(colors));
      assert.ok(Math.abs(colors.sticks - (0.327 + 0.245 + 0.245) / 3) < 0.02, JSON.stringify(colors));
      assert.ok(colors.dashes < 0.7 * colors.slips, 'the two modes differ by more than their colours');
    }
    assert.deepEqual(faults, []);
    await page.close();
  }
});

await browser.close();
rmSync(folder, { recursive: true, force: true });
process.exit(failed ? 1 : 0);
