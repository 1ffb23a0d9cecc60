// The timeline under the picture, and the map of the planar block. Both draw what `page` (page.js) holds.

const colours = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#7a5195', '#5f6b75'];
const dashes = [[], [7, 3], [2, 3], [9, 3, 2, 3]];
const cut = 1.5; // tilt over critical angle, above which the timeline shows no more

function sized(canvas) {
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  return scale;
}

// ---- the timeline

const colourOf = (b) => colours[b % colours.length];

// The pieces that have a colour: those that tilt most, of what they can, in their own order; one of each colour.
function coloured() {
  const most = page.curves.bodies.map((shares) => Math.max(0, ...shares));
  const taken = new Map();
  for (const b of most.map((_, i) => i).sort((a, c) => most[c] - most[a] || a - c))
    if (!taken.has(colourOf(b))) taken.set(colourOf(b), b);
  return [...taken.values()].sort((a, c) => a - c);
}

function buildKey() {
  page.coloured = coloured();
  const items = page.coloured.map((b) => {
    const item = document.createElement('li');
    const swatch = document.createElement('i');
    swatch.style.background = colourOf(b);
    item.append(swatch, page.names[b]);
    return item;
  });
  if (page.names.length > colours.length) {
    const more = document.createElement('li');
    more.textContent = '…';
    items.push(more);
  }
  byId('key').replaceChildren(...items);
}

function drawTimeline() {
  const canvas = byId('timeline');
  const scale = sized(canvas);
  const brush = canvas.getContext('2d');
  const style = getComputedStyle(document.documentElement);
  const ink = style.getPropertyValue('--ink'), line = style.getPropertyValue('--line');
  const soft = style.getPropertyValue('--soft');
  const width = canvas.width, height = canvas.height, letter = 12 * scale;
  const split = 0.64 * height, left = 0, right = width;
  const x = (t) => left + (t - start()) / Math.max(end() - start(), 1e-9) * (right - left);
  brush.clearRect(0, 0, width, height);
  brush.font = `${letter}px system-ui, sans-serif`;
  const y = (share) => split - Math.min(share, cut) / cut * (split - 1.4 * letter);
  brush.lineWidth = scale;
  brush.strokeStyle = soft;
  brush.setLineDash([4 * scale, 3 * scale]);
  brush.strokeRect(left, y(1), right - left, 0);
  brush.setLineDash([]);
  brush.strokeStyle = line;
  brush.strokeRect(left, split, right - left, 0);
  const { times } = page.curves;
  const path = (values, place) => {
    brush.beginPath();
    let begun = false;
    values.forEach((value, i) => {
      if (value === null) return void (begun = false);
      if (begun) brush.lineTo(x(times[i]), place(value)); else brush.moveTo(x(times[i]), place(value));
      begun = true;
    });
    brush.stroke();
  };
  brush.lineWidth = 1.6 * scale;
  brush.strokeStyle = soft;
  page.curves.bodies.forEach((shares, b) => {
    if (!page.coloured.includes(b)) path(shares, y);
  });
  page.coloured.forEach((b) => {
    brush.strokeStyle = colourOf(b);
    brush.setLineDash(dashes[b % dashes.length].map((d) => d * scale));
    path(page.curves.bodies[b], y);
  });
  brush.setLineDash([]);
  const middle = (split + height) / 2 + 0.4 * letter, reach = (height - split) / 2 - 0.6 * letter;
  brush.lineWidth = scale;
  brush.strokeStyle = soft;
  path(page.curves.floor, (gal) => middle - gal / page.curves.floor_scale * reach);
  brush.fillStyle = ink;
  brush.fillText(`${page.words.tilt} — ${page.words.critical}`, 2 * scale, letter);
  brush.fillText(`${page.words.floor} ±${shownNumber(page.curves.floor_scale)}`, 2 * scale, split + letter);
  brush.strokeStyle = style.getPropertyValue('--accent');
  brush.lineWidth = 2 * scale;
  brush.strokeRect(x(page.time), 0, 0, height);
}

// ---- the map of the planar block

function showMap(map) {
  page.mapped = map;
  byId('map').hidden = Boolean(map.obstacle);
  byId('nomap').hidden = !map.obstacle;
  if (map.obstacle) return void (byId('nomap').textContent = say('map_none', inWords(map.obstacle)));
  const style = getComputedStyle(document.documentElement);
  const fills = ['#e2e9f0', '#a9cbe4', '#a3203a'], words = ['map_stands', 'map_rocks', 'map_falls'];
  const canvas = byId('chart'), brush = canvas.getContext('2d');
  const left = 62, bottom = 290, top = 8, right = 472;
  brush.clearRect(0, 0, canvas.width, canvas.height);
  const across = (right - left) / map.columns, up = (bottom - top) / map.rows;
  map.points.forEach((verdict, k) => {
    const i = k % map.columns, j = Math.floor(k / map.columns);
    brush.fillStyle = fills[verdict];
    const x = Math.round(left + i * across), y = Math.round(bottom - (j + 1) * up);
    brush.fillRect(x, y, Math.round(left + (i + 1) * across) - x, Math.round(bottom - j * up) - y);
  });
  const place = (ends, value, count, from, length) =>
    from + (Math.log(value / ends[0]) / Math.log(ends[1] / ends[0]) * (count - 1) + 0.5) / count * length;
  brush.fillStyle = style.getPropertyValue('--ink');
  brush.font = '17px system-ui, sans-serif';
  brush.textAlign = 'center';
  for (const hertz of [0.2, 0.5, 1, 2, 5])
    brush.fillText(String(hertz), place(map.frequency, hertz, map.columns, left, right - left), bottom + 20);
  brush.fillText('Hz', (left + right) / 2, bottom + 42);
  brush.textAlign = 'right';
  for (const gal of [50, 100, 200, 500, 1000])
    brush.fillText(String(gal), left - 8, place(map.amplitude, gal, map.rows, bottom, top - bottom) + 6);
  brush.save();
  brush.translate(16, (top + bottom) / 2);
  brush.rotate(-Math.PI / 2);
  brush.textAlign = 'center';
  brush.fillText('gal', 0, 0);
  brush.restore();
  const clamp = (value, [low, high]) => Math.min(Math.max(value, low), high);
  const hx = place(map.frequency, clamp(map.here[0], map.frequency), map.columns, left, right - left);
  const hy = place(map.amplitude, clamp(map.here[1], map.amplitude), map.rows, bottom, top - bottom);
  brush.lineWidth = 5;
  for (const [ink, size] of [['#ffffff', 5], ['#000000', 2]]) {
    brush.strokeStyle = ink;
    brush.lineWidth = size;
    brush.beginPath();
    brush.arc(hx, hy, 8, 0, 2 * Math.PI);
    brush.stroke();
  }
  byId('mapkey').replaceChildren(...words.map((word, verdict) => {
    const item = document.createElement('li'), swatch = document.createElement('i');
    swatch.style.background = fills[verdict];
    item.append(swatch, page.words[word]);
    return item;
  }), Object.assign(document.createElement('li'), { textContent: `○ ${page.words.map_here}` }));
  canvas.setAttribute('aria-label', `${page.words.map}: ${page.names[page.piece]}`);
}
