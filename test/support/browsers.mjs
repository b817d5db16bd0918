// The browsers of this machine in which pages are tested: Chromium, and Firefox by the protocol WebDriver BiDi.
import { existsSync } from 'node:fs';
import { resolve } from 'node:path';

const paths = { Chromium: process.env.CHROMIUM ?? '/usr/bin/chromium', Firefox: process.env.FIREFOX ?? '/usr/bin/firefox-esr' };

// Starts each browser that is installed, or exits with status 77 if none is. Returns [{ name, browser }].
export async function browsers() {
  const skip = (why) => { console.log(`skipped: ${why}`); process.exit(77); };
  if (!Object.values(paths).some(existsSync)) skip(`no ${Object.values(paths).join(' and no ')}`);
  const { chromium, firefox } = await import(resolve('viewer/node_modules/playwright-core/index.mjs')).catch(() => skip('no playwright-core'));
  const started = [];
  if (existsSync(paths.Chromium))
    started.push({ name: 'Chromium', browser: await chromium.launch({
      executablePath: paths.Chromium,
      args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--disable-component-update'],
    }) });
  if (existsSync(paths.Firefox))
    started.push({ name: 'Firefox', browser: await firefox.launch({ channel: 'moz-firefox', executablePath: paths.Firefox }) });
  return started;
}
