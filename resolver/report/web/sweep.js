// The page of a sweep: everything is drawn from the JSON in #data, which `aaresolve sweep` wrote.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);
  const { axes, bases, variants } = data;
  const best = variants.find((v) => v.best) || variants[0];
  const someUnjudged = variants.some((v) => v.unjudged);
  const tooSmall = "this picture is too small to hold it against the best";
  const number = (v) => (v == null ? "–" : typeof v === "string" ? v : String(Number(v.toPrecision(5))).replace("-", "−"));

  // Figures with an interval first: gain over no anti-aliasing, and what is lost against the best of the same method.
  const held = (c) => c && { ...c, value: c.gain };
  const figures = [
    { name: "gain", title: "Gain over no anti-aliasing, dB", better: "high", of: (v) => held(v.gain), has: "its 95 % interval" },
    { name: "toBest", title: "Difference from the best value, dB", better: "high", of: (v) => held(v.toBest), has: "the 95 % interval of the difference; where it holds 0, the value cannot be told apart from the best" },
    ...data.figures.map((f) => ({ ...f, of: (v) => (v.values[f.name] == null ? null : { value: v.values[f.name] }), has: null })),
  ].filter((f) => variants.some((v) => f.of(v)));
  const shown = (f, e) => (e == null ? "–" : f.has ? signed(e.value) : number(e.value));
  const interval = (e) => (e && e.low != null ? intervalText(e) : null);

  $("shot").textContent = `Sweep: ${data.shot}`;
  $("subtitle").textContent = `${variants.length} variants against ${data.reference}; ${data.protocol}; ${data.line}`;
  $("version").textContent = data.version;
  $("words").append(...data.words.map((w) => element("li", {}, w)));

  // ---- what is shown ----
  const option = (text, value) => element("option", { value }, text);
  $("figure").append(...figures.map((f, i) => option(f.title, i)));
  $("along").append(...axes.map((a, i) => option(a.name, i)));
  const fixed = axes.map((_, a) => (best ? best.at[a] : 0)); // of axes that are neither along nor across
  const along = () => Number($("along").value), across = () => Number($("across").value || -1);
  const fillAcross = () => {
    const before = $("across").value;
    $("across").replaceChildren(...(bases.length > 1 ? [option("method", -1)] : []),
      ...axes.map((a, i) => [a, i]).filter(([, i]) => i !== along()).map(([a, i]) => option(a.name, i)));
    if ([...$("across").options].some((o) => o.value === before)) $("across").value = before;
    $("across-label").hidden = !$("across").options.length;
  };
  const fillFixed = () => {
    const free = axes.map((a, i) => [a, i]).filter(([, i]) => i !== along() && i !== across());
    $("fixed").replaceChildren(...free.map(([a, i]) => {
      const select = element("select", { "aria-label": a.name }, ...a.values.map((v, k) => option(v, k)));
      select.value = fixed[i];
      select.addEventListener("change", () => { fixed[i] = Number(select.value); draw(); });
      return element("label", {}, a.name + " ", select);
    }));
  };
  const fits = (v, ...free) => axes.every((_, a) => free.includes(a) || v.at[a] === fixed[a]);

  // ---- curves ----
  let chart;
  const drawCurve = (f) => {
    const a = along(), c = across(), along_ = axes[a];
    const groups = [];
    for (const [b, base] of bases.entries()) {
      const few = variants.filter((v) => v.base === b && fits(v, a, c));
      if (c < 0) groups.push([base, few, methodColour(methodIn(base))]);
      else axes[c].values.forEach((value, k) => groups.push([(bases.length > 1 ? base + ", " : "") + `${axes[c].name}=${value}`, few.filter((v) => v.at[c] === k)]));
    }
    const series = [0, 7, 14, 21, 4, 11, 18, 1].map((i) => methodColours[i]); // values of one method, neighbours far apart
    const x = (v) => (along_.numeric ? Number(along_.values[v.at[a]]) : along_.values[v.at[a]]);
    const datasets = [];
    groups.forEach(([label, few, ofMethod], i) => {
      const hue = ofMethod || series[i % series.length], dash = ofMethod ? [] : methodDash(Math.floor(i / series.length));
      const points = few.map((v) => [v, f.of(v)]).filter(([, e]) => e && typeof e.value === "number").sort(([v], [w]) => v.at[a] - w.at[a]);
      // The band first, so that the line lies on it: its lower end, then its upper one, filled down to it.
      if (f.has) for (const [end, fill] of [["low", false], ["high", "-1"]])
        datasets.push({ label, band: true, data: points.map(([v, e]) => ({ x: x(v), y: typeof e[end] === "number" ? e[end] : null })), borderWidth: 0, pointRadius: 0, pointHitRadius: 0, backgroundColor: hue + "38", fill });
      datasets.push({ label, data: points.map(([v, e]) => ({ x: x(v), y: e.value, e, v })), borderColor: hue, backgroundColor: hue, borderDash: dash, borderWidth: 2,
        pointRadius: points.map(([v]) => (v.best ? 8 : 4)), pointStyle: points.map(([v]) => (v.best ? "star" : "circle")), pointBorderWidth: points.map(([v]) => (v.best ? 2.5 : 1.5)),
        pointBackgroundColor: points.map(([v]) => (v.best || v.alike ? hue : v.unjudged ? css("--quiet") : css("--panel"))) });
    });
    dressCharts();
    if (chart) chart.destroy();
    chart = new Chart($("curve"), { type: "line", data: { labels: along_.numeric ? undefined : along_.values, datasets },
      options: { interaction: { mode: "nearest", axis: "x", intersect: false },
        scales: { x: { type: along_.numeric ? "linear" : "category", ...axis(along_.name), offset: !along_.numeric }, y: axis(f.title) },
        plugins: { ...legendBelow({ filter: (item, all) => !all.datasets[item.datasetIndex].band, shown: groups.length > 1 }),
          tooltip: { filter: (t) => !t.dataset.band, callbacks: { title: (t) => (t.length ? `${along_.name}=${along_.values[t[0].raw.v.at[a]]}` : ""),
            label: (t) => tipLines(t, `${t.dataset.label}: ${shown(f, t.raw.e)}` + (interval(t.raw.e) ? ` (${interval(t.raw.e)})` : "") + (t.raw.v.unjudged ? `; ${tooSmall}` : "")) } } } } });
    $("curve-title").textContent = `${f.title} against ${along_.name}: ${f.better === "high" ? "up" : "down"} is better`;
    $("curve-note").textContent = (f.has ? `Band: ${f.has}. ` : "No interval is known for this figure. ") + "Star: the best PSNR of its method; filled: cannot be told apart from it; " +
      (someUnjudged ? `grey: ${tooSmall}; ` : "") + "hollow: worse than it by what is resolved.";
  };

  // ---- heat maps ----
  const drawMaps = (f) => {
    const a = along(), c = across();
    $("maps").hidden = c < 0;
    if (c < 0) return;
    $("heat").replaceChildren(...bases.map((base, b) => {
      const cells = new Map(variants.filter((v) => v.base === b && fits(v, a, c)).map((v) => [`${v.at[a]} ${v.at[c]}`, v]));
      const values = [...cells.values()].map((v) => f.of(v)).filter((e) => e && typeof e.value === "number").map((e) => e.value);
      const low = Math.min(...values), high = Math.max(...values);
      // Lightest is best, and nothing is as dark as the ground of a dark page.
      const place = (v) => (high > low ? (f.better === "high" ? v - low : high - v) / (high - low) : 1);
      const colour = (v) => data.colours[Math.round((0.15 + 0.85 * place(v)) * (data.colours.length - 1))];
      const cell = (v) => {
        const e = v && f.of(v);
        if (!e || typeof e.value !== "number") return element("td", {}, e ? shown(f, e) : "–");
        const [red, green, blue] = colour(e.value);
        const light = 0.2126 * red + 0.7152 * green + 0.0722 * blue > 110;
        return element("td", { style: `background:rgb(${red} ${green} ${blue});color:${light ? "#000" : "#fff"}`, title: v.text + (interval(e) ? `: ${interval(e)}` : "") },
          shown(f, e) + (v.best ? " ★" : v.alike ? " ≈" : v.unjudged ? " ?" : ""));
      };
      return element("figure", { class: b ? "below" : null }, bases.length > 1 ? element("figcaption", {}, base) : null,
        element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": `${f.title} of ${base}` }, element("table", { class: "heat" },
          element("thead", {}, element("tr", {}, element("th", { scope: "col" }, `${axes[c].name} ↓  ${axes[a].name} →`), ...axes[a].values.map((value) => element("th", { scope: "col" }, value)))),
          element("tbody", {}, ...axes[c].values.map((value, k) => element("tr", {}, element("th", { scope: "row" }, value), ...axes[a].values.map((_, i) => cell(cells.get(`${i} ${k}`)))))))));
    }));
    $("heat").querySelectorAll(".scroll").forEach(tellOfMoreColumns);
    $("maps-note").textContent = `${f.title}; lighter is better. ★ the best PSNR of its method, ≈ cannot be told apart from it${someUnjudged ? `, ? ${tooSmall}` : ""}.`;
  };

  // ---- table ----
  const drawTable = () => {
    const order = [...variants].sort((v, w) => (Number(w.values.psnr) || -Infinity) - (Number(v.values.psnr) || -Infinity));
    const broken = (text) => text.split(/(?<=[:,])/).flatMap((part, i) => (i ? [element("wbr"), part] : [part]));
    const mark = (v) => (v.best ? element("small", { class: "better" }, "★ best") : v.alike ? element("small", { class: "unresolved" }, "≈ not told apart from the best") : v.unjudged ? element("small", { class: "unresolved" }, "? too small to judge") : null);
    // Of the best value against itself there is nothing to doubt.
    const doubts = (f, v) => (f.has && f.of(v) && !(v.best && f.name === "toBest") ? doubt(f.of(v)).filter(Boolean) : [])
      .map((s) => element("small", { class: s.startsWith("not resolved") ? "unresolved" : null }, s));
    $("all").replaceChildren(element("thead", {}, element("tr", {}, ...["Variant", ...figures.map((f) => f.title)].map((h) => element("th", { scope: "col" }, h)))),
      element("tbody", {}, ...order.map((v) => element("tr", {}, element("th", { scope: "row" }, ...broken(v.text), mark(v)),
        ...figures.map((f) => element("td", {}, shown(f, f.of(v)), ...doubts(f, v)))))));
    $("all-note").textContent = "Best PSNR first. Small: 95 % intervals.";
  };
  const draw = () => {
    const f = figures[Number($("figure").value)];
    drawCurve(f), drawMaps(f);
  };
  $("figure").addEventListener("change", draw);
  $("along").addEventListener("change", () => { fillAcross(), fillFixed(), draw(); });
  $("across").addEventListener("change", () => { fillFixed(), draw(); });
  fillAcross(), fillFixed(), drawTable(), draw();
  tellOfMoreColumns($("all").closest(".scroll"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => setTimeout(draw));
})();
