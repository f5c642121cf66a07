// SPDX-FileCopyrightText: 2026 Body Moments contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Adds an excerpt to each result of the search. Sphinx would fetch the pages for that, which browsers
// refuse for files on disk; texts.js, written by conf.py, holds the pages' texts instead.
const WIDTH = 240; // characters of an excerpt

function addExcerpt(item, words) {
  const link = item.querySelector("a");
  if (!link || item.querySelector(".excerpt")) return;
  const page = link.getAttribute("href").split(/[?#]/)[0].replace(/\.html$/, "");
  const text = PAGE_TEXTS[page];
  if (!text) return;
  const lower = text.toLowerCase();
  const found = words.map((word) => lower.indexOf(word)).filter((place) => place >= 0);
  const middle = found.length ? Math.min(...found) : 0;
  const start = Math.max(lower.lastIndexOf(" ", Math.max(middle - WIDTH / 3, 0)), 0);
  const excerpt = document.createElement("p");
  excerpt.className = "excerpt context";
  excerpt.textContent =
    (start ? "… " : "") + text.slice(start, start + WIDTH).trim() + " …";
  item.append(excerpt);
}

document.addEventListener("DOMContentLoaded", () => {
  const results = document.getElementById("search-results");
  if (!results) return;
  const script = document.createElement("script");
  script.src = "_static/texts.js";
  script.onload = () => {
    const query = new URLSearchParams(location.search).get("q") || "";
    const words = query.toLowerCase().split(/\s+/).filter(Boolean);
    const update = () => results.querySelectorAll("li").forEach((item) => addExcerpt(item, words));
    new MutationObserver(update).observe(results, { childList: true, subtree: true });
    update();
  };
  document.head.append(script);
});
