// Pages of the site and of a report in Chromium and Firefox, at the width of a desk and of a phone: axe-core finds no
// fault, nothing scrolls sideways, and no script reports an error. node accessibility.mjs SITE PROGRAM [--all] |
// --self-test. Exit status 77: there is no browser, or no axe-core.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { browsers } from '../support/browsers.mjs';

const self_test = process.argv[2] === '--self-test';
if (!existsSync('viewer/node_modules/axe-core/axe.min.js')) { console.log('skipped: no axe-core'); process.exit(77); }
const axe = readFileSync('viewer/node_modules/axe-core/axe.min.js', 'utf8');
const started = await browsers();
const folder = mkdtempSync(join(tmpdir(), 'anholon-site-'));

// The faults of a page with rule and place, each rule once.
async function faults(browser, file, width, dark) {
  const page = await browser.newPage({ viewport: { width, height: 800 }, colorScheme: dark ? 'dark' : 'light' });
  const found = [];
  page.on('pageerror', (e) => found.push(`script: ${e.message}`));
  page.on('request', (r) => { if (!/^(file|data|blob):/.test(r.url())) found.push(`asks for ${r.url()}`); });
  try {
    await page.goto(pathToFileURL(file).href);
    await page.waitForTimeout(300);
    const across = await page.evaluate(() => document.documentElement.scrollWidth);
    if (across > width) {
      const who = await page.evaluate(() => [...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > innerWidth + 1
        && ![...function* up(n) { for (let p = n.parentElement; p; p = p.parentElement) yield p; }(e)].some((p) => /auto|scroll|hidden|clip/.test(getComputedStyle(p).overflowX) && p !== document.body && p !== document.documentElement))
        .slice(0, 3).map((e) => `${e.tagName}.${e.className}`).join(', '));
      found.push(`scrolls sideways: ${across} of ${width}, by ${who}`);
    }
    await page.addScriptTag({ content: axe });
    // axe-core takes a MathML heading of a table for an empty one.
    found.push(...await page.evaluate(async () => (await axe.run(document)).violations
      .map((v) => ({ id: v.id, nodes: v.nodes.filter((n) => v.id !== 'empty-table-header' || !n.html.includes('<math')) })).filter((v) => v.nodes.length > 0)
      .map((v) => `${v.id} (${v.nodes.length}): ${v.nodes.slice(0, 2).map((n) => `${n.target.join(' ')} ${n.html.replace(/\s+/g, ' ').slice(0, 110)}`).join(' | ')}`)));
  } catch (e) { found.push(String(e)); }
  await page.close();
  return found;
}

if (self_test) {
  const bad = join(folder, 'bad.html');
  writeFileSync(bad, '<!doctype html><html><head><title>t</title></head><body><main><h1>x</h1><img src="data:,"><p style="color:#bbb">pale</p><div style="width:900px">wide</div></main></body></html>');
  let blind = 0;
  for (const { name, browser } of started) {
    const found = (await faults(browser, bad, 390, false)).join('\n');
    await browser.close();
    const missed = ['image-alt', 'color-contrast', 'html-has-lang', 'scrolls sideways'].filter((rule) => !found.includes(rule));
    console.log(`${name}: ${missed.length ? `not found: ${missed}` : 'the faults of a bad page are found'}`);
    blind += missed.length;
  }
  rmSync(folder, { recursive: true });
  process.exit(blind ? 1 : 0);
}

const site = resolve(process.argv[2]), program = resolve(process.argv[3]);
const report = join(folder, 'report.html');
execFileSync(program, ['report', 'disc', '-o', report, '--quiet'], { stdio: 'ignore' });
const all = (at) => readdirSync(at, { withFileTypes: true }).flatMap((e) => (e.isDirectory() ? all(join(at, e.name)) : e.name.endsWith('.html') ? [join(at, e.name)] : []));
const sample = ['index.html', 'search.html', 'genindex.html', 'doc/book/README.html', 'doc/recipes/README.html', 'doc/language.html', 'doc/commands.html', 'doc/outcomes.html', 'doc/json.html',
  'doc/theory/routh.html', 'doc/install.html', 'doc/python.html', 'gallery/index.html'].map((name) => join(site, name)).filter(existsSync);
const pages = process.argv.includes('--all') ? all(site).filter((f) => !/_static|gallery[/\\](?!index)/.test(f))
  : [...new Set([...sample, ...all(site).filter((f) => !/_static/.test(f)).filter((_, k) => k % 60 === 7)])];
let count = 0;
const rules = new Map();
await Promise.all(started.map(async ({ name, browser }) => {
  for (const page of [...pages, report]) {
    for (const [width, dark] of [[1280, false], [390, true]]) {
      for (const f of await faults(browser, page, width, dark)) {
        ++count;
        const rule = f.split(' ')[0];
        rules.set(rule, (rules.get(rule) ?? 0) + 1);
        if (rules.get(rule) <= 8) console.log(`FAULT ${page.replace(site, '')} at ${width} in ${name}: ${f}`);
      }
    }
  }
  await browser.close();
}));
rmSync(folder, { recursive: true, force: true });
console.log(`${pages.length + 1} pages in ${started.map((b) => b.name).join(' and ')}, ${count} faults${count ? `: ${[...rules].map(([r, n]) => `${r} ${n}`).join(', ')}` : ''}`);
process.exit(count > 0 ? 1 : 0);
