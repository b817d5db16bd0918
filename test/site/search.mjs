// The search of the site lists pages that hold most words of a question after the pages that hold all of them: node
// search.mjs | --self-test.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import vm from 'node:vm';

const script = readFileSync('doc/site/static/search.js', 'utf8');
const pages = {
  // Names of pages for users begin with doc/, which is left out here.
  sweeps: { parameter: 5, study: 5, sweep: 15 }, studio: { study: 5, page: 5 }, render: { film: 15, video: 5, page: 5 }, book: { parameter: 5, page: 5, film: 5 }, CHANGELOG: { top: 5 }, zoo: { top: 5 },
};

// A model of the search of Sphinx: pages that hold all words, with the score of the best word.
function search(text) {
  const of_all = (words) => Object.entries(pages).filter(([, held]) => [...words].every((w) => w in held))
    .map(([name, held]) => [name === 'CHANGELOG' ? name : `doc/${name}`, name, '', null, Math.max(...[...words].map((w) => held[w])), `${name}.md`, 'text']);
  const world = { Search: { performTermsSearch: of_all }, document: { addEventListener: (_event, f) => f() } };
  vm.runInNewContext(text, world);
  return (...words) => [...world.Search.performTermsSearch(new Set(words), new Set())].sort((a, b) => b[4] - a[4]).map((result) => result[0].replace('doc/', ''));
}

function check(text) {
  const find = search(text);
  assert.deepEqual(find('parameter', 'study'), ['sweeps', 'book', 'studio']);
  assert.deepEqual(find('video', 'film', 'mp4'), ['render']);
  assert.deepEqual(find('page', 'film', 'nowhere'), ['render', 'book']);
  assert.deepEqual(find('nowhere', 'never'), []);
  assert.deepEqual(find('top'), ['zoo', 'CHANGELOG']);
  assert.deepEqual(find('page'), ['studio', 'render', 'book']);
}

check(script);
if (process.argv[2] === '--self-test') {
  const mutants = [['result[4] -= .5', ''], ['2 * page.words', 'page.words'], ['page.words - words.size +', '100 +'], ['if (whole.has(result[0])) continue;', '']];
  const blind = mutants.filter(([from, to]) => {
    assert.ok(script.includes(from), from);
    try { check(script.replace(from, to)); return true; } catch { return false; }
  });
  console.log(`${mutants.length - blind.length} of ${mutants.length} mutants found${blind.map(([from]) => `; not found: ${from}`)}`);
  process.exit(blind.length > 0 ? 1 : 0);
}
console.log('the search of the site: ok');
