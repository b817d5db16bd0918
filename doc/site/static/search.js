// The search of the site: after the pages that hold all words of a question come those that hold most of them.
"use strict";
document.addEventListener("DOMContentLoaded", () => {
  if (typeof Search === "undefined") return;  // not the page of the search
  const for_developers = /^(?!doc\/|gallery\/|index$|models\/|python\/|NOTATION$)/;
  const with_all = Search.performTermsSearch;
  Search.performTermsSearch = (words, excluded) => {
    const found = with_all(words, excluded), most = 12;
    // Of pages with one score those for users come first.
    for (const result of found) if (for_developers.test(result[0])) result[4] -= .5;
    if (words.size < 2) return found;
    // A result is [docname, title, anchor, descr, score, filename, kind].
    const whole = new Set(found.map(result => result[0])), partly = new Map();
    for (const word of words) {
      for (const result of with_all(new Set([word]), excluded)) {
        if (whole.has(result[0])) continue;
        const page = partly.get(result[0]) || {result, words: 0, score: 0};
        ++page.words, page.score += result[4];
        partly.set(result[0], page);
      }
    }
    // These scores lie below those of all other results; what counts first is the number of words.
    for (const page of partly.values()) if (for_developers.test(page.result[0])) page.score -= .5;
    const pages = [...partly.values()].filter(page => 2 * page.words >= words.size)
      .sort((a, b) => b.words - a.words || b.score - a.score).slice(0, most);
    pages.forEach(page => { page.result[4] = page.words - words.size + page.score / (page.score + 1) - 1; });
    return [...found, ...pages.map(page => page.result)];
  };
});
