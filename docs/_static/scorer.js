// SPDX-FileCopyrightText: 2026 Body Moments contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ranks pages for users before those for developers. Sphinx reads it as `html_search_scorer`.
const FOR_DEVELOPERS =
  /^(api(\/|$)|changes|CONTRIBUTING|SECURITY|architecture|how-a-number-is-made|papers|listing)/;
var Scorer = {
  score: (result) => (FOR_DEVELOPERS.test(result[0]) ? result[4] - 1000 : result[4]),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
