// Functions that the tests of this folder share: a running studio, and pages whose faults are recorded.
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';

const axe = readFileSync('viewer/node_modules/axe-core/axe.min.js', 'utf8');

// Starts the studio with this model or sweep; `end` sends SIGINT and returns the exit status.
export async function studio(program, word, cwd = undefined) {
  const child = spawn(program, ['studio', word, '--no-browser', '--quiet'], { cwd, stdio: ['ignore', 'pipe', 'inherit'], env: { ...process.env, ANHOLON_CACHE: '' } });
  const address = await new Promise((done, fail) => {
    let text = '';
    child.stdout.on('data', (d) => { text += d; if (text.includes('\n')) done(text.trim()); });
    child.on('exit', (code) => fail(new Error(`the studio ended with status ${code}`)));
  });
  return { address, end: () => new Promise((done) => { child.removeAllListeners('exit'); child.on('exit', done); child.kill('SIGINT'); }) };
}

// Opens a page, which must give no error or warning and send requests to its own address only. `draws`: the browser has
// WebGL; on a machine without a screen, Firefox may have none.
export async function watched(browser, address, width = 1280) {
  const page = await browser.newPage({ viewport: { width, height: 800 } });
  const faults = [], draws = await page.evaluate(() => document.createElement('canvas').getContext('webgl2') !== null);
  page.on('console', (m) => { if ((m.type() === 'error' || m.type() === 'warning') && (draws || !m.text().includes('WebGL'))) faults.push(m.text()); });
  page.on('pageerror', (e) => faults.push(e.stack ?? e.message));
  page.on('request', (r) => { if (!r.url().startsWith(address) && !/^(data|blob):/.test(r.url())) faults.push(`asked for ${r.url()}`); });
  await page.goto(address);
  return { page, faults, draws };
}

// The number of colours in the picture of the player.
export const colour_count = (page) => page.evaluate(() => {
  const canvas = document.querySelector('.player canvas.view');
  if (!canvas || canvas.width === 0) return 0;
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const seen = new Set();
  for (let k = 0; k < data.length; k += 4) seen.add((data[k] << 16) | (data[k + 1] << 8) | data[k + 2]);
  return seen.size;
});

// The faults that axe-core finds; it takes a MathML heading of a table for an empty one. The content policy of the page
// lets no foreign script in, so axe-core is run by the debugger, which Firefox does not have.
export async function accessibility(page) {
  if (page.context().browser().browserType().name() !== 'chromium') return [];
  const session = await page.context().newCDPSession(page);
  await session.send('Runtime.evaluate', { expression: axe });
  const { result } = await session.send('Runtime.evaluate', {
    awaitPromise: true, returnByValue: true,
    expression: 'axe.run(document).then((r) => r.violations.map((v) => ({ id: v.id, nodes: v.nodes.filter((n) => v.id !== "empty-table-header" || !n.html.includes("<math>")) })).filter((v) => v.nodes.length > 0).map((v) => v.id + ": " + v.nodes.slice(0, 3).map((n) => n.html.slice(0, 160)).join(" | ")))',
  });
  return result.value;
}
