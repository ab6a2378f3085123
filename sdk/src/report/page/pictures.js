"use strict";
// The embedded pictures: half floats in base64 with a factor, decoded when a tab is first looked at.

// IEEE 754 binary16, by table.
const halfValues = (() => {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    const size = exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24;
    table[bits] = bits & 32768 ? -size : size;
  }
  return table;
})();

function decode(encoded) {
  const text = atob(encoded.data), values = new Float32Array(text.length / 2);
  for (let i = 0; i < values.length; ++i) values[i] = encoded.factor * halfValues[text.charCodeAt(2 * i) | (text.charCodeAt(2 * i + 1) << 8)];
  return values;
}

// Rec.709.
const luminanceAt = (values, pixel) => 0.2126 * values[3 * pixel] + 0.7152 * values[3 * pixel + 1] + 0.0722 * values[3 * pixel + 2];

// {width, height, ours, reference, difference, sigma, authored} as float arrays.
function decodeTab(tab) {
  if (tab.decoded) return tab.decoded;
  const ours = decode(tab.ours), difference = decode(tab.difference);
  const reference = ours.map((value, i) => value - difference[i]);
  const authored = tab.authored ? decode(tab.authored) : null;
  tab.decoded = { width: tab.width, height: tab.height, ours, reference, difference, sigma: decode(tab.sigma), authored };
  return tab.decoded;
}

// Luminance of ours - other, of ours, and the noise, each the mean over blocks of `block` x `block` pixels.
function blockMeans(picture, other, block) {
  const { width, height, ours, sigma } = picture;
  const columns = Math.ceil(width / block), rows = Math.ceil(height / block);
  const difference = new Float64Array(columns * rows), level = new Float64Array(columns * rows), variance = new Float64Array(columns * rows), count = new Float64Array(columns * rows);
  const exact = other === picture.reference ? picture.difference : null;
  for (let y = 0, p = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, ++p) {
      const b = Math.floor(y / block) * columns + Math.floor(x / block), own = luminanceAt(ours, p);
      difference[b] += exact ? luminanceAt(exact, p) : own - luminanceAt(other, p);
      level[b] += own;
      variance[b] += exact ? sigma[p] * sigma[p] : 0;
      count[b] += 1;
    }
  }
  for (let b = 0; b < count.length; ++b) {
    difference[b] /= count[b];
    level[b] = level[b] / count[b] - difference[b];
    variance[b] /= count[b] * count[b];
  }
  return { columns, difference, level, variance };
}
