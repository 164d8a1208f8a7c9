// LDR-FLIP [Andersson 2020] of two pictures of viewerMeasure's kind at 67 pixels per degree, as metrics/flip.h defines it;
// its constants come from formulas there, here from the same.
"use strict";
const viewerFlip = (() => {
  const PPD = 0.7 * (3840 / 0.7) * (Math.PI / 180);
  const normalised = (taps) => {
    const sum = taps.reduce((s, t, i) => s + (i ? 2 * t : t), 0);
    return taps.map((t) => t / sum);
  };
  const range = (reach, at) => Array.from({ length: reach + 1 }, (_, i) => at(i));
  // Contrast sensitivity: one Gaussian for luminance and for red-green, the sum of two for blue-yellow.
  const sensitivity = (b) => normalised(range(10, (i) => Math.exp((-Math.PI * Math.PI * (i / PPD) ** 2) / b)));
  const csf = { y: sensitivity(0.0047), cx: sensitivity(0.0053), wide: sensitivity(0.04), narrow: sensitivity(0.025) };
  // The share of each follows from its sum over the taps in two dimensions.
  const wideShare = (() => {
    const weight = (a, b) => {
      const line = range(10, (i) => Math.exp((-Math.PI * Math.PI * (i / PPD) ** 2) / b)).reduce((s, t, i) => s + (i ? 2 * t : t), 0);
      return a * Math.sqrt(Math.PI / b) * line * line;
    };
    const wide = weight(34.1, 0.04), narrow = weight(13.5, 0.025);
    return wide / (wide + narrow);
  })();
  // Features: a Gaussian, its first derivative, and its second.
  const SD = 0.5 * 0.082 * PPD, REACH = Math.ceil(3 * SD);
  const bell = range(REACH, (i) => Math.exp((-i * i) / (2 * SD * SD)));
  const gauss = normalised(bell);
  const edge = (() => {
    const taps = bell.map((g, i) => i * g), sum = taps.reduce((s, t) => s + t, 0);
    return taps.map((t) => t / sum);
  })();
  const point = (() => {
    const taps = bell.map((g, i) => ((i * i) / (SD * SD) - 1) * g);
    let positive = 0, negative = 0;
    taps.forEach((t, i) => { const both = i ? 2 * t : t; if (both > 0) positive += both; else negative -= both; });
    return taps.map((t) => t / (t > 0 ? positive : negative));
  })();

  const toXyz = [[0.4338953888315031, 0.37624237262225113, 0.1898622385462458], [0.21263682167732384, 0.7151829818412507, 0.07218019648142547],
    [0.01775242315172993, 0.10946562866246513, 0.872781948185805]];
  const toRgb = [[3.0803419882804612, -1.5373989694887855, -0.5429430187916752], [-0.9211783961651236, 1.875929983695176, 0.045248412469947596],
    [0.05288129287554323, -0.20401120612390997, 1.1511299132483668]];
  const kMaxColour = 41.276098414595445; // HyAB from green to blue after Hunt's adjustment, to the power 0.7

  const decode = (v) => (v <= 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4));
  const dot = (m, a, b, c) => m[0] * a + m[1] * b + m[2] * c;
  const labCurve = (t) => (t > 216 / 24389 ? Math.cbrt(t) : (t * 841) / 108 + 4 / 29);

  // One pass of taps along x or y, the edge repeated: even, odd (first derivative), or of differences from the centre, which
  // are exactly 0 on flat ground.
  const pass = (plane, w, h, taps, kind, alongY) => {
    const out = new Float64Array(w * h), reach = taps.length - 1, line = new Float64Array(w + 2 * reach);
    const sign = kind === "odd" ? -1 : 1, twice = kind === "differences" ? 2 : 0, centre = kind === "even" ? taps[0] : 0;
    for (let y = 0; y < h; y++) {
      const row = y * w;
      if (!alongY) {
        line.fill(plane[row], 0, reach);
        line.set(plane.subarray(row, row + w), reach);
        line.fill(plane[row + w - 1], reach + w);
      }
      for (let x = 0; x < w; x++) out[row + x] = centre * plane[row + x];
      for (let k = 1; k <= reach; k++) {
        const tap = taps[k], before = alongY ? Math.max(0, y - k) * w : reach - k, after = alongY ? Math.min(h - 1, y + k) * w : reach + k;
        const from = alongY ? plane : line;
        for (let x = 0; x < w; x++) out[row + x] += tap * (from[before + x] + sign * from[after + x] - twice * plane[row + x]);
      }
    }
    return out;
  };
  const both = (plane, w, h, taps) => pass(pass(plane, w, h, taps, "even", false), w, h, taps, "even", true);

  // Of one picture: what is seen of its colour (CIELab with Hunt's adjustment), and how strong edges and points are.
  const seen = ({ w, h, values }) => {
    const n = w * h, y = new Float64Array(n), cx = new Float64Array(n), cz = new Float64Array(n);
    for (let i = 0, k = 0; i < n; i++, k += 3) {
      const r = decode(values[k]), g = decode(values[k + 1]), b = decode(values[k + 2]);
      const X = dot(toXyz[0], r, g, b), Y = dot(toXyz[1], r, g, b), Z = dot(toXyz[2], r, g, b);
      y[i] = Y; cx[i] = 500 * (X - Y); cz[i] = 200 * (Y - Z);
    }
    const fy = both(y, w, h, csf.y), fx = both(cx, w, h, csf.cx), wide = both(cz, w, h, csf.wide), narrow = both(cz, w, h, csf.narrow);
    const L = new Float64Array(n), a = new Float64Array(n), b = new Float64Array(n);
    const unit = (v) => Math.min(Math.max(v, 0), 1);
    for (let i = 0; i < n; i++) {
      const Y = fy[i], X = Y + fx[i] / 500, Z = Y - (wide[i] * wideShare + narrow[i] * (1 - wideShare)) / 200;
      const r = unit(dot(toRgb[0], X, Y, Z)), g = unit(dot(toRgb[1], X, Y, Z)), blue = unit(dot(toRgb[2], X, Y, Z));
      const lx = labCurve(dot(toXyz[0], r, g, blue)), ly = labCurve(dot(toXyz[1], r, g, blue)), lz = labCurve(dot(toXyz[2], r, g, blue));
      L[i] = 116 * ly - 16;
      a[i] = 0.01 * L[i] * 500 * (lx - ly);
      b[i] = 0.01 * L[i] * 200 * (ly - lz);
    }
    const along = (first, kind1, second, kind2) => pass(pass(y, w, h, first, kind1, false), w, h, second, kind2, true);
    const length = (p, q) => p.map((v, i) => Math.hypot(v, q[i]));
    return { L, a, b, edge: length(along(edge, "odd", gauss, "even"), along(gauss, "even", edge, "odd")),
      point: length(along(point, "differences", gauss, "even"), along(gauss, "even", point, "differences")) };
  };
  // The map from what is seen of two pictures; the caller keeps seen() of the one that many are held against.
  const map = (w, h, t, r) => {
    const values = new Float64Array(w * h), knee = 0.4 * kMaxColour;
    for (let i = 0; i < values.length; i++) {
      const d = Math.pow(Math.abs(t.L[i] - r.L[i]) + Math.hypot(t.a[i] - r.a[i], t.b[i] - r.b[i]), 0.7);
      const colour = d < knee ? (d * 0.95) / knee : 0.95 + ((d - knee) * 0.05) / (kMaxColour - knee);
      const feature = Math.sqrt(Math.max(Math.abs(t.edge[i] - r.edge[i]), Math.abs(t.point[i] - r.point[i])) / Math.SQRT2);
      values[i] = Math.min(Math.pow(colour, 1 - feature), 1);
    }
    return { w, h, values };
  };
  return { seen, map, constants: { csf, wideShare, gauss, edge, point } };
})();
