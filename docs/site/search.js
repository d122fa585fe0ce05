// SPDX-License-Identifier: Apache-2.0
// Search: pages and their headings come first, attributes of the API and entries of its index after them.
var Scorer = {
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
  score: ([docname, title, anchor, descr, score, filename, kind]) => {
    const listed = /^reference\/(api|commands|parameters|messages|formulas)$/.test(docname);
    if (kind === "title" || kind === "text") return (listed ? 25 : kind === "title" ? 100 : 50) + score;
    return Math.min(score, 20);
  },
};
