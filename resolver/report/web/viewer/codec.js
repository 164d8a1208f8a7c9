// Unpacks the pictures that image/picture_codec.h packed: the same integers, in the same order.
"use strict";
const viewerCodec = (() => {
  const CLASSES = 33, NEAR = 14, BEFORE = 5;
  // The context of a word by how large its neighbours are together.
  const nearOf = Uint8Array.from({ length: 6 * CLASSES }, (_, sum) => (sum < 8 ? sum : Math.min(8 + Math.floor((sum - 8) / 6), NEAR - 1)));

  const bytesOf = (base64) => {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
    return bytes;
  };

  // Chances of a 1, each the mean of one that learns fast and one that learns slowly, in 16 bits, one behind the other.
  const chances = (n) => new Uint16Array(2 * n).fill(32768);

  const decoder = (bytes) => {
    // low, high, code: in an array, since a variable of 32 bits that functions share costs an object at every change.
    const range = new Uint32Array([0, 0xffffffff, 0]), LOW = 0, HIGH = 1, CODE = 2;
    let at = 0;
    const next = () => { range[CODE] = (range[CODE] << 8) | (at < bytes.length ? bytes[at] : 0); at++; };
    for (let i = 0; i < 4; i++) next();
    const get = (chance) => {
      const low = range[LOW], width = (range[HIGH] - low) >>> 0;
      const mid = (low + Math.imul(width >>> 16, chance) + (Math.imul(width & 0xffff, chance) >>> 16)) >>> 0, bit = range[CODE] <= mid;
      if (bit) range[HIGH] = mid; else range[LOW] = mid + 1;
      while (((range[LOW] ^ range[HIGH]) & 0xff000000) === 0) {
        range[LOW] <<= 8;
        range[HIGH] = (range[HIGH] << 8) | 255;
        next();
      }
      return bit ? 1 : 0;
    };
    const bit = (chances, i) => {
      const fast = chances[2 * i], slow = chances[2 * i + 1], one = (fast + slow) >>> 1;
      const b = get(one < 32 ? 32 : one > 65503 ? 65503 : one);
      if (b) { chances[2 * i] = fast + ((65535 - fast) >> 4); chances[2 * i + 1] = slow + ((65535 - slow) >> 7); }
      else { chances[2 * i] = fast - (fast >> 4); chances[2 * i + 1] = slow - (slow >> 7); }
      return b;
    };
    return { bit, plain: () => get(32768) };
  };

  // Words of a picture, channel by channel: green, red, blue; Uint8Array or Uint32Array by `bits`. `other` are the words
  // that it was coded against, or null; `med` is whether neighbours give a guess.
  const words = (bytes, w, h, bits, other, med) => {
    const n = w * h, out = bits === 8 ? new Uint8Array(3 * n) : new Uint32Array(3 * n), { bit, plain } = decoder(bytes);
    const more = chances(BEFORE * NEAR * CLASSES), sign = chances(BEFORE), second = chances(BEFORE * CLASSES);
    // With a border of zeros above and beside, so that no pixel needs to ask where it lies.
    const W = w + 2;
    let classes = new Uint8Array(W * (h + 1)), classesBefore = new Uint8Array(W * (h + 1));
    const difference = new Int32Array(n), narrow = bits === 8 ? 24 : 0;
    for (let c = 0; c < 3; c++) {
      if (c > 0) [classes, classesBefore] = [classesBefore, classes];
      const from = c * n;
      for (let y = 0, i = 0; y < h; y++)
        for (let x = 0, k = (y + 1) * W + 1; x < w; x++, i++, k++) {
          const near = nearOf[2 * classes[k - 1] + 2 * classes[k - W] + classes[k - W - 1] + classes[k - W + 1]];
          const beside = classesBefore[k], before = c === 0 ? 0 : beside < BEFORE - 2 ? 1 + beside : BEFORE - 1;
          const context = (before * NEAR + near) * CLASSES;
          let level = 0;
          while (level < bits && bit(more, context + level)) level++;
          classes[k] = level;
          let left = 0;
          if (level > 0) {
            const negative = bit(sign, before);
            left = 1;
            if (level > 1) left = (left << 1) | bit(second, before * CLASSES + level);
            for (let k = level - 3; k >= 0; k--) left = (left << 1) | plain();
            if (negative) left = -left | 0;
          }
          if (med) {
            if (y === 0) left += x === 0 ? 0 : difference[i - 1];
            else if (x === 0) left += difference[i - w];
            else {
              const west = difference[i - 1], north = difference[i - w], both = difference[i - w - 1];
              const top = west > north ? west : north, bottom = west > north ? north : west;
              left += both >= top ? bottom : both <= bottom ? top : (west + north - both) | 0;
            }
          }
          const word = ((left | 0) << narrow) >> narrow;
          difference[i] = word;
          let base = other ? other[from + i] : c === 0 && bits === 8 ? 128 : 0;
          if (c > 0) base += out[i] - (other ? other[i] : 0);
          out[from + i] = word + base;
        }
    }
    return out;
  };

  const order = [1, 0, 2];
  // R G B R G B ... of 8-bit words.
  const codes = (words, n) => {
    const rgb = new Uint8Array(3 * n);
    for (let c = 0; c < 3; c++) for (let i = 0, k = order[c]; i < n; i++, k += 3) rgb[k] = words[c * n + i];
    return rgb;
  };
  // Of 32-bit words, the floats that they stand for.
  const floats = (words, n) => {
    const rgb = new Float32Array(3 * n), bits = new Uint32Array(rgb.buffer);
    for (let c = 0; c < 3; c++)
      for (let i = 0, k = order[c]; i < n; i++, k += 3) {
        const word = words[c * n + i];
        bits[k] = word >>> 31 ? word & 0x7fffffff : ~word;
      }
    return rgb;
  };
  return { bytesOf, words, codes, floats };
})();
