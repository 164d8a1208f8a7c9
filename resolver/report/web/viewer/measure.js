// Figures and maps of shown pictures, as the program computes them (conventions 13), in double. A picture here is
// {w, h, values}: encoded values 0 to 1, R G B R G B ...; a map is {w, h, values} with one number per pixel.
"use strict";
const viewerMeasure = (() => {
  // Mean over pixels and channels of (T - R)^2 within `area` [x, y, w, h]; null: the whole picture.
  const mse = (test, reference, area) => {
    const [x0, y0, w, h] = area ?? [0, 0, test.w, test.h];
    let sum = 0;
    for (let y = y0; y < y0 + h; y++)
      for (let i = 3 * (y * test.w + x0), end = i + 3 * w; i < end; i++) {
        const d = test.values[i] - reference.values[i];
        sum += d * d;
      }
    return sum / (3 * w * h);
  };
  const psnr = (error) => (error > 0 ? -10 * Math.log10(error) : Infinity);
  const meanOf = (map, area) => {
    const [x0, y0, w, h] = area ?? [0, 0, map.w, map.h];
    let sum = 0;
    for (let y = y0; y < y0 + h; y++) for (let x = x0; x < x0 + w; x++) sum += map.values[y * map.w + x];
    return sum / (w * h);
  };

  const luma = (picture) => { // BT.601
    const out = new Float64Array(picture.w * picture.h), v = picture.values;
    for (let i = 0, k = 0; i < out.length; i++, k += 3) out[i] = 0.299 * v[k] + 0.587 * v[k + 1] + 0.114 * v[k + 2];
    return out;
  };
  // Root mean square over the channels of (T - R).
  const rms = (test, reference) => {
    const values = new Float64Array(test.w * test.h), t = test.values, r = reference.values;
    for (let i = 0, k = 0; i < values.length; i++, k += 3) {
      const a = t[k] - r[k], b = t[k + 1] - r[k + 1], c = t[k + 2] - r[k + 2];
      values[i] = Math.sqrt((a * a + b * b + c * c) / 3);
    }
    return { w: test.w, h: test.h, values };
  };

  // One symmetric filter along x, then along y; `taps` from the centre outwards, the edge repeated.
  const blurred = (plane, w, h, taps) => {
    const reach = taps.length - 1, along = new Float64Array(w * h), out = new Float64Array(w * h);
    for (let y = 0; y < h; y++)
      for (let x = 0; x < w; x++) {
        const row = y * w;
        let sum = taps[0] * plane[row + x];
        for (let i = 1; i <= reach; i++) sum += taps[i] * (plane[row + Math.max(0, x - i)] + plane[row + Math.min(w - 1, x + i)]);
        along[row + x] = sum;
      }
    for (let y = 0; y < h; y++) {
      const row = y * w;
      for (let x = 0; x < w; x++) out[row + x] = taps[0] * along[row + x];
      for (let i = 1; i <= reach; i++) {
        const up = Math.max(0, y - i) * w, down = Math.min(h - 1, y + i) * w;
        for (let x = 0; x < w; x++) out[row + x] += taps[i] * (along[up + x] + along[down + x]);
      }
    }
    return out;
  };
  // SSIM of luma: 11 x 11 Gaussian, sigma 1.5, replicated border [Wang 2004].
  const ssimTaps = (() => {
    const taps = Array.from({ length: 6 }, (_, i) => Math.exp((-i * i) / (2 * 1.5 * 1.5)));
    const sum = taps.reduce((s, t, i) => s + (i ? 2 * t : t), 0);
    return taps.map((t) => t / sum);
  })();
  const ssim = (test, reference) => {
    const { w, h } = test, t = luma(test), r = luma(reference), c1 = 0.01 ** 2, c2 = 0.03 ** 2;
    const filtered = (at) => blurred(Float64Array.from({ length: w * h }, (_, i) => at(i)), w, h, ssimTaps);
    const mt = blurred(t, w, h, ssimTaps), mr = blurred(r, w, h, ssimTaps);
    const tt = filtered((i) => t[i] * t[i]), rr = filtered((i) => r[i] * r[i]), tr = filtered((i) => t[i] * r[i]);
    const values = new Float64Array(w * h);
    for (let i = 0; i < values.length; i++) {
      const vt = tt[i] - mt[i] * mt[i], vr = rr[i] - mr[i] * mr[i], both = tr[i] - mt[i] * mr[i];
      values[i] = ((2 * mt[i] * mr[i] + c1) * (2 * both + c2)) / ((mt[i] * mt[i] + mr[i] * mr[i] + c1) * (vt + vr + c2));
    }
    return { w, h, values };
  };

  // What flickers, in 8-bit codes, of the pictures of successive frames. At rest: the standard deviation of luma over the
  // frames, whose mean is the program's flicker at rest. In motion, with the truth's frames: the root mean square of the
  // steps from frame to frame that the truth does not make at the same pixel.
  const flicker = (pictures, truths) => {
    const { w, h } = pictures[0], n = w * h, values = new Float64Array(n);
    if (truths) {
      let before = null;
      pictures.forEach((p, k) => {
        const t = luma(p), r = luma(truths[k]);
        for (let i = 0; i < n; i++) t[i] -= r[i];
        if (before) for (let i = 0; i < n; i++) values[i] += (t[i] - before[i]) ** 2;
        before = t;
      });
      for (let i = 0; i < n; i++) values[i] = 255 * Math.sqrt(values[i] / Math.max(1, pictures.length - 1));
    } else {
      const mean = new Float64Array(n);
      pictures.forEach((p, k) => { // Welford
        const y = luma(p);
        for (let i = 0; i < n; i++) {
          const d = y[i] - mean[i];
          mean[i] += d / (k + 1);
          values[i] += d * (y[i] - mean[i]);
        }
      });
      for (let i = 0; i < n; i++) values[i] = 255 * Math.sqrt(Math.max(0, values[i]) / pictures.length);
    }
    return { w, h, values };
  };
  return { mse, psnr, meanOf, luma, rms, blurred, ssim, flicker };
})();
