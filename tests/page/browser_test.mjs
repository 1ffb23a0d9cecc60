// Opens a live page in a browser, without a display (Firefox draws no WebGL without: under Xvfb), as its reader does, and looks at what becomes of it:
//   node browser_test.mjs chromium|firefox PAGE.html FOLDER [WIDTH HEIGHT]
// The page is a copy with two scripts more: one that hears what the console is told, one that acts. Its findings
// and pictures of its canvases go to FOLDER. Exit code 1 where a finding is not as it should be.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

const [browser, page, folder, width = '1280', height = '900'] = process.argv.slice(2);
const longest = 240000; // ms

const listener = `
window.heard = [];
for (const kind of ['log', 'info', 'warn', 'error', 'debug']) {
  const before = console[kind];
  console[kind] = (...of) => { heard.push(kind + ': ' + of.map(String).join(' ')); before.apply(console, of); };
}
addEventListener('error', (event) => heard.push('error: ' + event.message));
addEventListener('unhandledrejection', (event) => heard.push('rejected: ' + event.reason));
`;

function actor(port) {
  return `(async () => {
  const found = {};
  const wait = (ms) => new Promise((resume) => setTimeout(resume, ms));
  const until = async (holds, what) => {
    for (let i = 0; i < 1200 && !holds(); ++i) await wait(50);
    if (!holds()) throw new Error('waited in vain for ' + what);
  };
  const frame = () => new Promise((resume) => requestAnimationFrame(() => requestAnimationFrame(resume)));
  const text = (id) => document.getElementById(id).textContent;
  const picture = () => { drawPicture(); return document.getElementById('picture').toDataURL(); };
  const sent = (value) => fetch('http://127.0.0.1:${port}/', { method: 'POST', mode: 'no-cors', body: JSON.stringify(value) });
  const pointer = (kind, id, x, y, target, type = 'mouse') => {
    const box = target.getBoundingClientRect();
    target.dispatchEvent(new PointerEvent(kind, { pointerId: id, pointerType: type, bubbles: true, cancelable: true,
      buttons: kind === 'pointerup' ? 0 : 1, clientX: box.left + x, clientY: box.top + y }));
  };
  const key = (target, name) => target.dispatchEvent(new KeyboardEvent('keydown', { key: name, bubbles: true, cancelable: true }));
  Element.prototype.setPointerCapture = () => {};  // of pointers that no device has
  try {
    await until(() => document.documentElement.dataset.ready === 'true', 'the page');
    await frame();
    found.title = text('title');
    found.verdict = text('verdict');
    found.recorded = text('source');
    found.replay_only = document.getElementById('only').hidden ? '' : text('only');
    found.controls = document.querySelectorAll('#controls input').length;
    found.unnamed = [...document.querySelectorAll('button, input, select, canvas')].filter((one) =>
      !one.closest('[hidden]') && one.getAttribute('aria-hidden') !== 'true' && !(one.labels && one.labels.length) &&
      !one.getAttribute('aria-label') && !one.textContent.trim() && one.id !== 'scale').length;
    found.wider_than_screen = document.documentElement.scrollWidth > innerWidth;
    const canvas = document.getElementById('picture');
    found.drawn = page.drawable;
    found.legend = text('quantity');
    const first = picture();
    found.picture = first;
    pointer('pointerdown', 1, 200, 200, canvas); pointer('pointermove', 1, 320, 220, canvas); pointer('pointerup', 1, 320, 220, canvas);
    const turned = picture();
    found.drag_turns = turned !== first;
    pointer('pointerdown', 2, 200, 200, canvas, 'touch'); pointer('pointerdown', 3, 260, 200, canvas, 'touch');
    pointer('pointermove', 3, 320, 200, canvas, 'touch'); pointer('pointerup', 2, 200, 200, canvas, 'touch'); pointer('pointerup', 3, 320, 200, canvas, 'touch');
    const zoomed = picture();
    found.touch_zooms = zoomed !== turned;
    key(canvas, 'ArrowLeft');
    found.key_turns = picture() !== zoomed;
    const timeline = document.getElementById('timeline');
    pointer('pointerdown', 4, timeline.clientWidth * 0.5, 10, timeline); pointer('pointerup', 4, timeline.clientWidth * 0.5, 10, timeline);
    await frame();
    found.timeline_seeks = Number(document.getElementById('time').value);
    found.last = Number(document.getElementById('time').max);
    key(document.body, ' ');
    await until(() => Number(document.getElementById('time').value) > found.timeline_seeks + 0.1, 'the play');
    found.space_plays = Number(document.getElementById('time').value) - found.timeline_seeks;
    if (page.playing) key(document.body, ' ');
    await frame();
    document.querySelector('[data-view="3"]').click();
    if (found.replay_only === '') {
      await until(() => page.mapped, 'the map');
      const amplitude = [...document.querySelectorAll('#controls input')].find((one) => one.dataset.key.endsWith('.amplitude'));
      if (amplitude) {
        amplitude.value = 0.02; amplitude.dispatchEvent(new Event('input', { bubbles: true }));
        const begun = performance.now();
        await until(() => page.changed, 'the run');
        found.run_ms = Math.round(performance.now() - begun);
        found.gentle = text('verdict');
        found.hash = page.hash;
        await until(() => page.mapped, 'the map');
      }
      document.getElementById('back').click();
      await frame();
      found.back = text('verdict');
    }
    document.getElementById('language').click();
    await frame();
    found.japanese = text('verdict');
    found.lang = document.documentElement.lang;
    document.getElementById('dark').click(); document.getElementById('projector').click();
    await frame();
    found.dark = picture();
    found.timeline = timeline.toDataURL();
    found.chart = document.getElementById('chart').toDataURL();
    found.trouble = text('trouble');
    found.still_wide = document.documentElement.scrollWidth > innerWidth;
  } catch (error) { found.failed = String(error && error.stack || error); }
  found.heard = heard;
  await sent(found);
})();`;
}

const server = http.createServer((request, response) => {
  let body = '';
  request.on('data', (part) => { body += part; });
  request.on('end', () => {
    response.end();
    if (body) conclude(JSON.parse(body));
  });
});

let child = null;
const home = fs.mkdtempSync(path.join(os.tmpdir(), 'topple-page-'));

function conclude(found) {
  if (child) process.kill(-child.pid, 'SIGKILL');
  fs.mkdirSync(folder, { recursive: true });
  for (const name of ['picture', 'dark', 'timeline', 'chart']) {
    const at = found[name] || '';
    if (at.startsWith('data:image/png;base64,')) fs.writeFileSync(path.join(folder, `${browser}-${name}.png`), Buffer.from(at.slice(22), 'base64'));
    delete found[name];
  }
  fs.writeFileSync(path.join(folder, `${browser}.json`), JSON.stringify(found, null, 1));
  console.log(JSON.stringify(found, null, 1));
  const live = found.replay_only === '';
  const wrong = Object.entries({
    'it fails': found.failed !== undefined,
    'the console is told something': found.heard.length > 0,
    'it says who falls': !found.verdict,
    'a control has no name': found.unnamed !== 0,
    'it is wider than the screen': found.wider_than_screen || found.still_wide,
    'it draws nothing': found.drawn !== true,
    'a drag turns nothing': found.drag_turns !== true,
    'two fingers zoom nothing': found.touch_zooms !== true,
    'an arrow key turns nothing': found.key_turns !== true,
    'the timeline does not seek': !(Math.abs(found.timeline_seeks / found.last - 0.5) < 0.02),
    'Space does not play': !(found.space_plays > 0.1),
    'the other language says the same': found.japanese === found.verdict,
    'it shows trouble': Boolean(found.trouble),
    'a live page has no controls': live && !(found.controls > 0),
    'a gentle shake says the same': live && found.gentle !== undefined && found.gentle === found.verdict,
    'the way back says something else': live && found.back !== found.verdict,
  }).filter(([, holds]) => holds).map(([what]) => what);
  for (const what of wrong) console.error(`${browser}: ${what}`);
  fs.rmSync(home, { recursive: true, force: true, maxRetries: 5 });
  process.exit(wrong.length > 0 ? 1 : 0);
}

server.listen(0, '127.0.0.1', () => {
  const { port } = server.address();
  const copy = path.join(home, 'page.html');
  const html = fs.readFileSync(page, 'utf8')
    .replace('<head>', () => `<head><script>${listener}</script>`)
    .replace('</body>', () => `<script>${actor(port)}</script></body>`);
  fs.writeFileSync(copy, html);
  const profile = path.join(home, 'profile');
  fs.mkdirSync(profile);
  fs.writeFileSync(path.join(profile, 'user.js'), [
    'webgl.force-enabled', 'gfx.webrender.software', 'webgl.disable-fail-if-major-performance-caveat',
  ].map((name) => `user_pref("${name}", true);`).join('\n') + '\nuser_pref("datareporting.policy.dataSubmissionEnabled", false);\n');
  const size = browser === 'chromium' ? `--window-size=${width},${height}` : [`--width=${width}`, `--height=${height}`];
  const command = browser === 'chromium'
    ? ['chromium', '--headless', '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
       '--no-first-run', '--disable-background-networking', `--user-data-dir=${profile}`, size, `file://${copy}`]
    : ['xvfb-run', '-a', 'firefox-esr', '--no-remote', '--profile', profile, ...size, `file://${copy}`];
  child = spawn(command[0], command.slice(1), { stdio: 'ignore', detached: true, env: { ...process.env, HOME: home } });
  child.on('error', (error) => conclude({ failed: `${command[0]}: ${error.message}`, heard: [] }));
  setTimeout(() => conclude({ failed: 'no answer', heard: [] }), longest);
});
