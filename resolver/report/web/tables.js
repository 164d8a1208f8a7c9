// Numbers as text and tables whose columns sort, for the pages of one run and of several.
"use strict";
// JSON carries Inf and NaN as text.
const value = (v) => (v === "Inf" ? Infinity : v === "-Inf" ? -Infinity : v === "NaN" ? NaN : v);
const fixed = (v, digits) => {
  const n = value(v);
  return n == null ? "–" : Number.isFinite(n) ? n.toFixed(digits) : n > 0 ? "Inf" : n < 0 ? "−Inf" : "NaN";
};
const minus = (text) => (/^-0\.?0*$/.test(text) ? text.slice(1) : text.replace("-", "−"));
const signed = (v) => (value(v) > 0 ? "+" : "") + fixed(v, 2).replace("-", "−");
const short = (v) => (v == null ? "–" : Number.isFinite(value(v)) ? Number(value(v).toPrecision(4)).toString() : fixed(v, 0));
// As a figure of the program's table is written: {form}.
const inForm = (figure, v) => (v == null ? "–" : figure.form === "similarity" ? fixed(v, 6) : figure.form === "decibels" ? fixed(v, 2) : figure.form === "jod" ? fixed(v, 3) : short(v));

// ---- doubt: a comparison is {gain, low, high, resolved, why} ----
const reasons = { truthNoise: "not resolved: the truth’s noise", varies: "not resolved: varies over the picture", tooSmall: "not resolved: too small to judge", equal: "not resolved: the same picture but for rounding" };
const intervalText = (c) => {
  const [low, high] = [c.low, c.high].map((v) => Number.isFinite(value(v)));
  return low && high ? `${signed(c.low)} to ${signed(c.high)}` : low ? `above ${signed(c.low)}` : high ? `below ${signed(c.high)}` : "no interval";
};
// Under a gain: its interval, and why it is not resolved where it is not.
const doubt = (c) => c && [c.why === "tooSmall" || c.why === "equal" ? null : intervalText(c), c.resolved ? null : reasons[c.why] ?? "not resolved"];

// One rule for the colour of a gain in every table: a method is better or worse only where that is resolved.
const gainTone = (gain, resolved) => (!resolved || gain == null ? "" : value(gain) >= 0 ? "better" : "worse");

// A table of rows whose columns sort on a click: {title, get, show, small, tone, better}, each called with rowOf(i) and i.
// `small` gives a line or several under the figure, `about` says in a phrase what the column is. A column without any
// value is left out, unless it is to be kept. Returns the columns that are there.
const sortableTable = (table, shown, allColumns, rowOf, headOf, first = "Method") => {
  const known = (v) => v != null && !Number.isNaN(v);
  const columns = allColumns.filter((c) => c && (c.keep || shown.some((i) => known(c.get(rowOf(i), i)))));
  let rows = shown.slice(), sortedBy = null, descending = true;
  const draw = () => {
    const heads = columns.map((c, k) => element("th", { scope: "col", "aria-sort": sortedBy === k ? (descending ? "descending" : "ascending") : "none" },
      Object.assign(element("button", { type: "button", title: c.about }, c.title), { onclick: () => sortBy(k) })));
    table.replaceChildren(
      element("thead", {}, element("tr", {}, element("th", { scope: "col" }, first), ...heads)),
      element("tbody", {}, ...rows.map((i) => {
        const row = rowOf(i);
        return element("tr", {}, element("th", { scope: "row" }, ...headOf(row)), ...columns.map((c) => {
          const small = [c.small && c.small(row, i)].flat().filter(Boolean);
          return element("td", { class: c.tone ? c.tone(row, i) : null }, c.show ? c.show(row, i) : short(c.get(row, i)),
            ...small.map((s) => element("small", { class: s.startsWith("not resolved") ? "unresolved" : null }, s)));
        }));
      })));
  };
  const sortBy = (k) => {
    descending = sortedBy === k ? !descending : columns[k].better !== "low";
    sortedBy = k;
    const key = (i) => { const v = columns[k].get(rowOf(i), i); return known(v) ? v : null; };
    rows = shown.slice().sort((a, b) => {
      const x = key(a), y = key(b);
      if (x === null || y === null) return (x === null) - (y === null);
      return x === y ? 0 : (x < y) === descending ? 1 : -1;
    });
    draw();
    table.querySelectorAll("thead button")[k].focus();
  };
  draw();  return columns;
};
// What each column of a table says, to unfold under it.
const columnNotes = (columns) => element("details", { class: "columns" }, element("summary", {}, "What the columns say"),
  element("dl", {}, ...columns.filter((c) => c.about).flatMap((c) => [element("dt", {}, c.title), element("dd", {}, c.about)])));
