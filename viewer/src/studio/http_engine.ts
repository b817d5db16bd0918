// The program behind HTTP on the loopback address. Addresses are relative, since the path of the page holds the token.

import type { Answer, CaseMotion, Checked, Chosen, Engine, Failed, Language, Motion, Opened, Sections, Store, SweepMap } from './engine.ts';

const page = Array.from(crypto.getRandomValues(new Uint8Array(8)), (b) => b.toString(16).padStart(2, '0')).join('');

const lost = (why: string): Failed => ({
  error: { text: `the program does not answer: ${why}`, hint: 'start anholon studio again', outcome: '', diagnostics: [] },
});

// Makes the answer for a text that the program refuses.
const refused = (why: string): Failed => ({
  error: { text: why, hint: 'the command line takes longer texts', outcome: '', diagnostics: [] },
});

async function ask<T>(what: string, of: Chosen, edition: number): Promise<Answer<T>> {
  try {
    const reply = await fetch(what, { method: 'POST', body: of.text, headers: { 'X-Anholon-Page': page, 'X-Anholon-Edition': String(edition), 'X-Anholon-Case': encodeURIComponent(of.case_name) } });
    if (reply.status === 413) return refused((await reply.text()).trim());
    if (!reply.ok) return lost((await reply.text()).trim() || String(reply.status));
    return await reply.json() as Answer<T>;
  } catch (e) { return lost((e as Error).message); }
}

async function get<T>(what: string): Promise<T> {
  const reply = await fetch(what);
  if (!reply.ok) throw new Error((await reply.text()).trim());
  return await reply.json() as T;
}

// The hash of the file when this page last read or saved it.
let known = '';

export const http_engine: Engine & Store = {
  check: (of, edition) => ask<Checked>('check', of, edition),
  simulate: (of, edition) => ask<Motion>('simulate', of, edition),
  derive: (of, edition) => ask<Sections>('derive', of, edition),
  prove: (of, edition) => ask<Sections>('prove', of, edition),
  motion_of_case: (number, edition) => ask<CaseMotion>('case', { text: String(number), case_name: '' }, edition),
  sweep: () => get<SweepMap | Failed>('sweep'),
  async open() {
    const opened = await get<Opened>('model');
    known = opened.hash;
    return opened;
  },
  language: () => get<Language>('language'),
  async save(text, anyway) {
    try {
      const reply = await fetch(anyway ? 'save-anyway' : 'save', { method: 'POST', body: text, headers: { 'X-Anholon-Known': known } });
      if (reply.ok) {
        known = (await reply.json() as { hash: string }).hash;
        return 'saved';
      }
      const body = await reply.text();
      let why = body.trim();
      try { why = (JSON.parse(body) as Failed).error.text; } catch { /* plain text */ }
      return { why, changed: reply.status === 409 };
    } catch (e) { return { why: `the program does not answer: ${(e as Error).message}`, changed: false }; }
  },
};
