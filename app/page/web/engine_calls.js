'use strict';
// How the page and its Worker call the engine, which is the program's own code.

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// What gzip has packed.
function unpacked(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

// What both the page and its Worker do with an engine. Its source goes to the Worker as text.
function wrap(module) {
  const lend = (bytes, use) => {
    const at = module._malloc(Math.max(bytes.length, 1));
    module.HEAPU8.set(bytes, at);
    try { return use(at); } finally { module._free(at); }
  };
  const text = (value) => new Uint8Array([...new TextEncoder().encode(value), 0]);
  const parsed = (at) => {
    const answer = JSON.parse(module.UTF8ToString(at));
    if (answer && answer.error) throw new Error(answer.error);
    return answer;
  };
  return {
    module,
    parsed,
    withText: (value, use) => lend(text(value), use),
    addFile: (name, bytes) =>
      lend(text(name), (n) => lend(bytes, (b) => module._page_file(n, b, bytes.length))),
    load: (name, scene, values) =>
      lend(text(name), (n) => lend(text(scene), (s) =>
        lend(text(JSON.stringify(values)), (v) => parsed(module._page_load(n, s, v))))),
    show: (bytes, hits) =>
      lend(bytes, (at) => lend(text(JSON.stringify(hits)), (h) =>
        parsed(module._page_show(at, bytes.length, h)))),
    rows: () => {
      const at = module._page_pack();
      return module.HEAPU8.slice(at, at + module._page_packed_size());
    },
  };
}

// Runs in the Worker. One run at a time: a newer request ends the one before it.
function workerMain() {
  const slice = 40; // ms between looks at what is asked for
  let engine = null, scene = null, ready = null, newest = 0;
  const pause = () => new Promise((resume) => setTimeout(resume, 0));
  async function run(request) {
    engine.load(scene.name, scene.text, request.values);
    engine.parsed(engine.module._page_start());
    for (;;) {
      const now = engine.parsed(engine.module._page_advance(slice));
      if (now.over) break;
      postMessage({ kind: 'progress', id: request.id, time: now.time });
      await pause();
      if (request.id !== newest) return;
    }
    const outcome = engine.parsed(engine.module._page_outcome());
    const rows = engine.rows();
    postMessage({ kind: 'rows', id: request.id, rows, outcome }, [rows.buffer]);
    await map(request);
  }
  async function map(request) {
    for (;;) {
      const found = engine.parsed(engine.module._page_map(request.piece, slice));
      if (found.obstacle || found.complete) return postMessage({ kind: 'map', id: request.id, map: found });
      await pause();
      if (request.id !== newest) return;
    }
  }
  onmessage = async (event) => {
    const request = event.data;
    try {
      if (request.kind === 'scene') {
        scene = request;
        ready = ToppleEngine({ wasmBinary: request.binary }).then((module) => {
          engine = wrap(module);
          for (const file of scene.files) engine.addFile(file.name, file.bytes);
        });
        return;
      }
      newest = request.id;
      await ready;
      if (request.id !== newest) return;
      if (request.kind === 'run') return await run(request);
      engine.load(scene.name, scene.text, request.values);
      await map(request);
    } catch (error) {
      postMessage({ kind: 'trouble', id: request.id, message: String(error.message || error) });
    }
  };
}
