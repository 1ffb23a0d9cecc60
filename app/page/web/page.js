// The live page: shows the rows that it holds, and has a Worker compute others when a control moves. What is
// computed, drawn and said comes from the engine, which is the program's own code.

const byId = (id) => document.getElementById(id);
const data = JSON.parse(byId('data').textContent);

const page = {
  engine: null, worker: null, words: {}, controls: [], values: [], bodies: data.bodies, curves: null, coloured: [],
  time: 0, playing: false, last: 0, colour: 0, japanese: data.language === 'ja', request: 0, changed: false,
  drawable: true, dirty: true, fine: true, slow: false, moving: false, moved: 0, mapped: null, names: [],
  trouble: '', legend: '', updates: [], piece: 0,
};

const say = (word, ...of) => of.reduce((text, value, i) => text.split(`{${i}}`).join(value), page.words[word]);
// Of what the Worker says, in English and Japanese.
const inWords = (texts) => texts[page.japanese ? 1 : 0];
const end = () => page.curves.times[page.curves.times.length - 1];
const start = () => page.curves.times[0];
const dark = () => (document.documentElement.classList.contains('dark') ? 1 : 0);

function setWords() {
  page.engine.module._page_language(page.japanese ? 1 : 0);
  page.words = page.engine.parsed(page.engine.module._page_words_json());
  document.documentElement.lang = page.japanese ? 'ja' : 'en';
  for (const one of document.querySelectorAll('[data-word]')) one.textContent = page.words[one.dataset.word];
  const language = byId('language');
  language.textContent = page.japanese ? 'English' : '日本語';
  language.lang = page.japanese ? 'en' : 'ja';
  byId('time').setAttribute('aria-label', page.words.time);
  byId('picture').setAttribute('aria-label', page.words.picture);
  const select = byId('colour');
  const names = page.engine.parsed(page.engine.module._page_colours());
  select.replaceChildren(...names.map((name, i) => new Option(name, i, false, i === page.colour)));
  if (!data.live) byId('only').textContent = say(data.reason, data.estimate_s);
  byId('thinned').hidden = data.stride < 2;
  byId('thinned').textContent = say('thinned', data.stride);
}

// ---- controls

const shownNumber = (x) => (Math.abs(x) >= 1000 ? x.toFixed(0) : String(Number(x.toPrecision(3))));
const toSlider = (control, x) =>
  control.logarithmic ? Math.log(x / control.least) / Math.log(control.most / control.least)
    : (x - control.least) / (control.most - control.least);
function fromSlider(control, u) {
  const x = control.logarithmic ? control.least * (control.most / control.least) ** u
    : control.least + u * (control.most - control.least);
  const step = 10 ** Math.floor(Math.log10(Math.max(Math.abs(x), (control.most - control.least) / 100)) - 2);
  return Number((Math.round(x / step) * step).toPrecision(6));
}

function buildControls() {
  const form = byId('controls');
  form.replaceChildren();
  page.updates = [];
  form.hidden = !data.live;
  let group = null, box = null;
  page.controls.forEach((control, i) => {
    const name = control.group ? `${control.heading}: ${control.group}` : control.heading;
    if (name !== group) {
      group = name;
      box = document.createElement('fieldset');
      const legend = document.createElement('legend');
      legend.textContent = name;
      box.append(legend);
      form.append(box);
    }
    box.append(controlRow(control, i));
  });
}

// Controls that follow this one change with it as long as they have their share of its value.
function setControl(i, value) {
  const before = page.values[i];
  page.values[i] = value;
  page.controls.forEach((control, j) => {
    if (j !== i && !(control.follows === i && page.values[j] === control.share * before)) return;
    if (j !== i) page.values[j] = control.share * value;
    page.updates[j](j === i);
  });
}

function controlRow(control, i) {
  const row = document.createElement('div');
  row.className = 'control';
  const label = document.createElement('label');
  label.textContent = control.label;
  label.htmlFor = `control-${i}`;
  const input = document.createElement('input');
  input.id = label.htmlFor;
  input.dataset.key = control.key;
  const output = document.createElement('output');
  output.htmlFor = input.id;
  const update = () => {
    const value = page.values[i];
    row.classList.toggle('changed', value !== control.value);
    if (control.kind === 'toggle') return;
    output.textContent = `${shownNumber(value)} ${control.unit}`;
    input.setAttribute('aria-valuetext', output.textContent);
  };
  if (control.kind === 'toggle') {
    input.type = 'checkbox';
    input.checked = page.values[i] !== 0;
  } else {
    Object.assign(input, { type: 'range', min: 0, max: 1, step: 0.001 });
    input.value = toSlider(control, page.values[i]);
  }
  input.addEventListener('input', () => {
    setControl(i, control.kind === 'toggle' ? Number(input.checked) : fromSlider(control, Number(input.value)));
    if (control.body >= 0) choosePiece(control.body);
    compute();
  });
  page.updates[i] = (held) => {
    if (!held) input.value = toSlider(control, page.values[i]);
    update();
  };
  update();
  row.append(label, output, input);
  return row;
}

// ---- runs

let waiting = 0;
function compute() {
  if (!page.worker) return;
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    page.worker.postMessage({ kind: 'run', id: ++page.request, values: page.values, piece: page.piece });
    byId('progress').hidden = false;
    byId('progress').value = 0;
    byId('source').textContent = page.words.computing;
  }, 120);
}

function fromWorker(event) {
  const message = event.data;
  if (message.id !== page.request) return;
  if (message.kind === 'progress') {
    byId('progress').value = message.time / page.duration;
    return;
  }
  if (message.kind === 'map') return showMap(message.map);
  byId('progress').hidden = true;
  if (message.kind === 'trouble') {
    byId('source').textContent = page.words.before;
    byId('back').hidden = false;
    return complain(message.message);
  }
  page.changed = page.controls.some((control, i) => control.value !== page.values[i]);
  page.bodies = message.outcome.bodies;
  page.hash = message.outcome.hash;
  complain(message.outcome.trouble || '');
  show(message.rows, message.outcome.hits);
}

// trouble: a text, or one in each language.
function complain(trouble) {
  page.trouble = trouble;
  byId('trouble').hidden = !trouble;
  byId('trouble').textContent = Array.isArray(trouble) ? inWords(trouble) : trouble;
}

function show(rows, hits) {
  const loaded = page.engine.load(data.name, data.text, page.values);
  page.names = loaded.bodies;
  page.duration = loaded.duration;
  page.shown = { rows, hits };
  page.curves = page.engine.show(rows, hits);
  page.time = Math.min(Math.max(page.time, start()), end());
  Object.assign(byId('time'), { min: start(), max: end() });
  sayVerdict();
  buildKey();
  page.dirty = true;
}

function sayVerdict() {
  byId('source').textContent = page.changed ? page.words.changed : page.words.recorded;
  byId('back').hidden = !page.changed;
  byId('verdict').textContent = data.loads ? data.loads[page.japanese ? 'ja' : 'en']
    : page.engine.withText(JSON.stringify(page.bodies), (at) =>
      page.engine.parsed(page.engine.module._page_verdict(at))).words;
}

function backToRecorded() {
  ++page.request;
  page.values = page.controls.map((control) => control.value);
  page.changed = false;
  page.bodies = data.bodies;
  byId('progress').hidden = true;
  complain('');
  buildControls();
  show(bytesOf(data.rows), data.hits);
  askForMap();
}

function askForMap() {
  if (page.worker) page.worker.postMessage({ kind: 'map', id: ++page.request, values: page.values, piece: page.piece });
}

// The piece of which the map is.
function choosePiece(number) {
  page.piece = number;
  byId('piece').value = number;
}

function buildPieces() {
  byId('pieces').hidden = !data.live || page.names.length < 2;
  byId('piece').replaceChildren(...page.names.map((name, i) => new Option(name, i, false, i === page.piece)));
}

// ---- the picture

function view(number) {
  const canvas = byId('picture');
  page.engine.module._page_view(number, canvas.clientWidth / Math.max(canvas.clientHeight, 1));
  page.dirty = true;
}

function drawPicture() {
  const now = page.engine.parsed(page.engine.module._page_at(page.time, page.colour));
  showNow(now);
  if (!page.drawable) return;
  const canvas = byId('picture');
  sized(canvas);
  try {
    page.engine.withText('#picture', (at) =>
      page.engine.parsed(page.engine.module._page_draw(at, canvas.width, canvas.height, dark(), page.fine ? 1 : 0)));
  } catch (error) {
    page.drawable = false;
    showStills();
    byId('nopicture').hidden = false;
  }
}

function showStills() {
  byId('stills').hidden = false;
  byId('frame').classList.add('still');
  for (const id of ['picture', 'views', 'legend', 'hint']) byId(id).hidden = true;
}

function showNow(now) {
  byId('now').style.minHeight = `${now.most_lines * 1.45}em`;
  byId('now').replaceChildren(...now.lines.map((line) => {
    const row = document.createElement('div');
    row.textContent = line;
    return row;
  }));
  byId('colours').hidden = !now.quantity;  // nothing has a stress
  byId('legend').hidden = !now.quantity || !page.drawable;
  const legend = JSON.stringify(
    [now.quantity, now.unit, now.minimum, now.maximum, now.signed, now.notes, now.range, dark()]);
  if (legend === page.legend || !now.quantity) return;
  page.legend = legend;
  byId('quantity').textContent = now.unit ? `${now.quantity}, ${now.unit}` : now.quantity;
  byId('range').textContent = [now.range, ...now.notes].filter(Boolean).join(' · ');
  const brush = byId('scale').getContext('2d');
  const image = brush.createImageData(256, 1);
  const at = page.engine.module._page_colour_map(now.signed ? 1 : 0, dark());
  for (let i = 0; i < 256; ++i) {
    image.data.set(page.engine.module.HEAPU8.subarray(at + 3 * i, at + 3 * i + 3), 4 * i);
    image.data[4 * i + 3] = 255;
  }
  brush.putImageData(image, 0, 0);
  const shares = now.signed ? [0, 0.5, 1] : [0, 0.25, 0.5, 1];
  byId('ticks').replaceChildren(...shares.map((share) => {
    const tick = document.createElement('span');
    const part = now.square_root ? share * share : share;
    tick.textContent = shownNumber(now.minimum + part * (now.maximum - now.minimum));
    tick.style.left = `${100 * share}%`;
    return tick;
  }));
}

// ---- time

function setTime(time) {
  page.time = Math.min(Math.max(time, start()), end());
  page.dirty = true;
}

function play(on) {
  if (on && page.time >= end()) page.time = start();
  page.playing = on;
  page.last = performance.now();
  page.dirty = true;
}

// Where frames take long, coarser shadows while something moves, and fine ones once it rests.
const slowFrame = 60, rest = 250; // ms
function chooseQuality(now) {
  if (page.dirty || page.playing) {
    if (page.moving && now - page.moved > slowFrame) page.slow = true;
    page.moving = true;
    page.moved = now;
    page.fine = !page.slow;
    return;
  }
  page.moving = false;
  if (!page.fine && now - page.moved > rest) {
    page.fine = true;
    page.dirty = true;
  }
}

function tick(now) {
  chooseQuality(now);
  if (page.playing) {
    page.time += (now - page.last) / 1000;
    page.last = now;
    if (page.time >= end()) {
      page.time = end();
      page.playing = false;
    }
    page.dirty = true;
  }
  if (page.dirty) {
    page.dirty = false;
    byId('play').textContent = page.playing ? page.words.pause : page.words.play;
    byId('time').value = page.time;
    const clock = `${page.time.toFixed(2)} s / ${shownNumber(end())} s`;
    byId('clock').textContent = clock;
    byId('time').setAttribute('aria-valuetext', clock);
    drawPicture();
    drawTimeline();
  }
  requestAnimationFrame(tick);
}

// ---- what the reader does

function listenToPicture() {
  const canvas = byId('picture'), module = page.engine.module, held = new Map();
  const change = (move) => {
    move();
    page.dirty = true;
  };
  const zoom = (factor, x, y) =>
    change(() => module._page_zoom(factor, x, y, canvas.clientWidth, canvas.clientHeight));
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
  });
  canvas.addEventListener('pointermove', (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    const now = { x: event.offsetX, y: event.offsetY };
    const dx = now.x - before.x, dy = now.y - before.y;
    held.set(event.pointerId, now);
    const other = [...held].find(([id]) => id !== event.pointerId);
    if (other) {
      const away = (at) => Math.max(Math.hypot(at.x - other[1].x, at.y - other[1].y), 1);
      zoom(away(now) / away(before), (now.x + other[1].x) / 2, (now.y + other[1].y) / 2);
      change(() => module._page_pan(dx / 2, dy / 2, canvas.clientHeight));
    } else if (event.shiftKey || event.buttons === 2) {
      change(() => module._page_pan(dx, dy, canvas.clientHeight));
    } else {
      change(() => module._page_rotate(dx, dy));
    }
  });
  for (const kind of ['pointerup', 'pointercancel'])
    canvas.addEventListener(kind, (event) => held.delete(event.pointerId));
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    zoom(1.0015 ** -event.deltaY, event.offsetX, event.offsetY);
  }, { passive: false });
  canvas.addEventListener('keydown', (event) => {
    const turns = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
    const nearer = { '+': 1.2, '=': 1.2, '-': 1 / 1.2 };
    if (turns[event.key]) change(() => module._page_rotate(...turns[event.key]));
    else if (nearer[event.key]) zoom(nearer[event.key], canvas.clientWidth / 2, canvas.clientHeight / 2);
    else return;
    event.preventDefault();
  });
}

function listen() {
  listenToPicture();
  byId('play').addEventListener('click', () => play(!page.playing));
  byId('time').addEventListener('input', () => {
    page.playing = false;
    setTime(Number(byId('time').value));
  });
  const timeline = byId('timeline');
  const seek = (event) => {
    if (event.type === 'pointerdown') timeline.setPointerCapture(event.pointerId);
    else if (event.buttons === 0) return;
    page.playing = false;
    setTime(start() + event.offsetX / timeline.clientWidth * (end() - start()));
  };
  timeline.addEventListener('pointerdown', seek);
  timeline.addEventListener('pointermove', seek);
  document.addEventListener('keydown', (event) => {
    if (event.key !== ' ' || /^(INPUT|BUTTON|SELECT)$/.test(event.target.tagName)) return;
    event.preventDefault();
    play(!page.playing);
  });
  for (const button of document.querySelectorAll('[data-view]'))
    button.addEventListener('click', () => view(Number(button.dataset.view)));
  byId('colour').addEventListener('change', () => {
    page.colour = Number(byId('colour').value);
    page.dirty = true;
  });
  byId('back').addEventListener('click', backToRecorded);
  byId('piece').addEventListener('change', () => {
    choosePiece(Number(byId('piece').value));
    if (byId('progress').hidden) askForMap(); else compute();
  });
  byId('controls').addEventListener('submit', (event) => event.preventDefault());
  byId('language').addEventListener('click', () => {
    page.japanese = !page.japanese;
    page.legend = '';
    setWords();
    page.controls = page.engine.load(data.name, data.text, page.values).controls;
    buildControls();
    relabel();
  });
  byId('dark').addEventListener('change', () => {
    document.documentElement.classList.toggle('dark', byId('dark').checked);
    if (page.mapped) showMap(page.mapped);
    page.dirty = true;
  });
  byId('projector').addEventListener('change', () => {
    document.documentElement.classList.toggle('projector', byId('projector').checked);
    page.dirty = true;
  });
  window.addEventListener('resize', () => { page.dirty = true; });
}

function relabel() {
  page.engine.show(page.shown.rows, page.shown.hits);
  sayVerdict();
  complain(page.trouble);
  if (page.mapped) showMap(page.mapped);
  page.dirty = true;
}

function startWorker() {
  const source = `${byId('engine').textContent}\n${wrap}\n(${workerMain})();`;
  const url = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  page.worker = new Worker(url);
  page.worker.onmessage = fromWorker;
  page.worker.postMessage({ kind: 'scene', name: data.name, text: data.text, binary: page.binary,
    files: data.files.map((file) => ({ name: file.name, bytes: bytesOf(file.base64) })) });
}

function giveUp() {
  showStills();
  for (const id of ['transport', 'timeline', 'source', 'controls', 'map', 'pieces']) byId(id).hidden = true;
  document.querySelector('nav').hidden = true;
  byId('only').textContent = data.no_engine;
}

async function begin() {
  page.binary = await unpacked(bytesOf(byId('binary').textContent));
  page.engine = wrap(await ToppleEngine({ wasmBinary: page.binary }));
  setWords();
  for (const file of data.files) page.engine.addFile(file.name, bytesOf(file.base64));
  const loaded = page.engine.load(data.name, data.text, []);
  page.controls = loaded.controls;
  page.values = page.controls.map((control) => control.value);
  buildControls();
  show(bytesOf(data.rows), data.hits);
  buildPieces();
  view(3);
  listen();
  if (data.live) {
    startWorker();
    askForMap();
  }
  requestAnimationFrame(tick);
  document.documentElement.dataset.ready = 'true';
}

const able = ['WebAssembly', 'Worker', 'DecompressionStream'].every((name) => name in window);
if (able) begin().catch((error) => {
  giveUp();
  complain(String(error.message || error));
});
else giveUp();
