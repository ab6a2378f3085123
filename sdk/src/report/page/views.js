// From luminances to colours on the screen.

// Middle grey at EV: L = 2^EV K/100, K = 12.5 (ISO 2720); the brightest that a sensor holds is 1.2 x 2^EV (ISO 12232, saturation-based speed).
const middleLuminance = (ev) => 0.125 * 2 ** ev;
const saturation = (ev) => 1.2 * 2 ** ev;

const toSrgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
// Narkowicz's fit of the ACES reference transform (2016), which darkens: 1/0.6 makes middle grey stay near where it was.
const filmic = (v) => { const x = v / 0.6; return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14); };

// A curve from [0, limit] to bytes by table: 4096 steps in the square root.
function curveTable(curve) {
  const limit = 16, table = new Uint8ClampedArray(4097);
  for (let i = 0; i <= 4096; ++i) {
    const v = limit * (i / 4096) ** 2;
    table[i] = Math.round(255 * toSrgb(Math.min(1, curve === "filmic" ? filmic(v) : v)));
  }
  return (v) => table[v <= 0 ? 0 : Math.min(4096, Math.round(4096 * Math.sqrt(v / limit)))];
}

// Colour scales as a few points, linear between them: dark to bright for luminance, blue - grey - red for differences.
const brightness = [[8, 8, 32], [44, 22, 96], [104, 32, 128], [170, 50, 116], [224, 86, 78], [248, 146, 54], [250, 208, 92], [254, 252, 214]];
const signed = [[20, 60, 140], [50, 120, 200], [140, 190, 230], [236, 236, 234], [244, 176, 140], [214, 84, 60], [130, 16, 30]];
function scaleTable(points) {
  const table = new Uint8ClampedArray(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const place = (i / 255) * (points.length - 1), k = Math.min(points.length - 2, Math.floor(place)), t = place - k;
    for (let c = 0; c < 3; ++c) table[3 * i + c] = points[k][c] * (1 - t) + points[k + 1][c] * t;
  }
  return table;
}
const brightnessTable = scaleTable(brightness), signedTable = scaleTable(signed);
const clampByte = (t) => (t > 0 ? Math.min(255, Math.round(255 * t)) : 0);

const stopsAround = 5;  // of middle grey, each way, in the luminance view
const sigmaReach = 4;

// Fills columns [from, to) of `pixels` (RGBA) with `values` (RGB, cd/m2).
function drawPicture(pixels, width, height, values, from, to, ev, curve) {
  const toByte = curveTable(curve), factor = 1 / saturation(ev);
  for (let y = 0; y < height; ++y) {
    for (let x = from; x < to; ++x) {
      const p = y * width + x;
      for (let c = 0; c < 3; ++c) pixels[4 * p + c] = toByte(values[3 * p + c] * factor);
      pixels[4 * p + 3] = 255;
    }
  }
}

function drawLuminance(pixels, width, height, values, from, to, ev) {
  const middle = middleLuminance(ev);
  for (let y = 0; y < height; ++y) {
    for (let x = from; x < to; ++x) {
      const p = y * width + x, luminance = luminanceAt(values, p);
      const i = 3 * clampByte(luminance > 0 ? 0.5 + Math.log2(luminance / middle) / (2 * stopsAround) : 0);
      pixels.set(brightnessTable.subarray(i, i + 3), 4 * p);
      pixels[4 * p + 3] = 255;
    }
  }
}

// measure(b): the block's value as a part of the scale's end.
function drawDifference(pixels, width, height, blocks, block, measure) {
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const b = Math.floor(y / block) * blocks.columns + Math.floor(x / block), i = 3 * clampByte(0.5 + measure(b) / 2);
      pixels.set(signedTable.subarray(i, i + 3), 4 * (y * width + x));
      pixels[4 * (y * width + x) + 3] = 255;
    }
  }
}

// Three digits that matter.
function readable(value) {
  const size = Math.abs(value);
  if (!Number.isFinite(value)) return "–";
  if (size >= 1e5 || (size < 1e-3 && size > 0)) return value.toExponential(2).replace("-", "−");
  return Number(value.toPrecision(4)).toString().replace("-", "−");
}
