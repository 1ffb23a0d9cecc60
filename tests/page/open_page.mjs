// Opens a live page in a browser, without a display (Firefox draws no WebGL without: under Xvfb), as its reader does.
// The page is a copy with three scripts more: one that hears what the console is told, one that comes before those of
// the page, and one that acts.
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';

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

// What `act` can call.
const helpers = `
const wait = (ms) => new Promise((resume) => setTimeout(resume, ms));
const until = async (holds, what) => {
  for (let i = 0; i < 1200 && !holds(); ++i) await wait(50);
  if (!holds()) throw new Error('waited in vain for ' + what);
};
const frame = () => new Promise((resume) => requestAnimationFrame(() => requestAnimationFrame(resume)));
const text = (id) => document.getElementById(id).textContent;
const visible = (id) => document.getElementById(id).getClientRects().length > 0;
const pointer = (kind, id, x, y, target, type = 'mouse') => {
  const box = target.getBoundingClientRect();
  target.dispatchEvent(new PointerEvent(kind, { pointerId: id, pointerType: type, bubbles: true, cancelable: true,
    buttons: kind === 'pointerup' ? 0 : 1, clientX: box.left + x, clientY: box.top + y }));
};
const key = (target, name) => target.dispatchEvent(new KeyboardEvent('keydown', { key: name, bubbles: true, cancelable: true }));
const slider = (end) => [...document.querySelectorAll('#controls input')].find((one) => one.dataset.key.endsWith(end));
const move = (input, to) => { input.value = to; input.dispatchEvent(new Event('input', { bubbles: true })); };
// visible controls that have no name
const unnamed = () => [...document.querySelectorAll('button, input, select, canvas')].filter((one) =>
  one.getClientRects().length > 0 && one.getAttribute('aria-hidden') !== 'true' && !(one.labels && one.labels.length) &&
  !one.getAttribute('aria-label') && !one.textContent.trim() && one.id !== 'scale').length;
Element.prototype.setPointerCapture = () => {};  // of pointers that no device has
`;

function command(browser, flags, profile, size, url) {
  const [width, height] = size;
  if (browser === 'chromium')
    return ['chromium', '--headless', '--no-sandbox', '--no-first-run', '--disable-background-networking', ...flags,
      `--user-data-dir=${profile}`, `--window-size=${width},${height}`, url];
  return ['xvfb-run', '-a', 'firefox-esr', '--no-remote', '--profile', profile, `--width=${width}`, `--height=${height}`, url];
}

export const software = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];

// Resolves to what the text `act`, the body of an async function, puts into `found`; with `failed` where it
// throws. flags: of Chromium.
export function openPage({ browser, page, act, before = '', flags = software, size = [1280, 900] }) {
  const home = fs.mkdtempSync(path.join(os.tmpdir(), 'topple-page-'));
  let child = null;
  return new Promise((resolve) => {
    const server = http.createServer((request, response) => {
      let body = '';
      request.on('data', (part) => { body += part; });
      request.on('end', () => {
        response.end();
        if (body) conclude(JSON.parse(body));
      });
    });
    const late = setTimeout(() => conclude({ failed: 'no answer', heard: [] }), longest);
    function conclude(found) {
      clearTimeout(late);
      if (child && child.pid) process.kill(-child.pid, 'SIGKILL');
      server.close();
      server.closeAllConnections();
      fs.rmSync(home, { recursive: true, force: true, maxRetries: 5 });
      resolve(found);
    }
    server.listen(0, '127.0.0.1', () => {
      const actor = `(async () => {
        const found = {};
        ${helpers}
        try { ${act} } catch (error) { found.failed = String(error && error.stack || error); }
        found.heard = heard;
        await fetch('http://127.0.0.1:${server.address().port}/', { method: 'POST', mode: 'no-cors', body: JSON.stringify(found) });
      })();`;
      const copy = path.join(home, 'page.html');
      fs.writeFileSync(copy, fs.readFileSync(page, 'utf8')
        .replace('<head>', () => `<head><script>${listener}${before}</script>`)
        .replace('</body>', () => `<script>${actor}</script></body>`));
      const profile = path.join(home, 'profile');
      fs.mkdirSync(profile);
      fs.writeFileSync(path.join(profile, 'user.js'), [
        'webgl.force-enabled', 'gfx.webrender.software', 'webgl.disable-fail-if-major-performance-caveat',
      ].map((name) => `user_pref("${name}", true);`).join('\n') + '\nuser_pref("datareporting.policy.dataSubmissionEnabled", false);\n');
      const [program, ...of] = command(browser, flags, profile, size, `file://${copy}`);
      child = spawn(program, of, { stdio: 'ignore', detached: true, env: { ...process.env, HOME: home } });
      child.on('error', (error) => conclude({ failed: `${program}: ${error.message}`, heard: [] }));
    });
  });
}

// Writes what was found to FOLDER/NAME.json, its pictures to FOLDER/NAME-KEY.png, and ends with exit code 1 where
// one of `wrong` holds.
export function report(found, folder, name, wrong) {
  fs.mkdirSync(folder, { recursive: true });
  for (const [key, value] of Object.entries(found)) {
    if (typeof value !== 'string' || !value.startsWith('data:image/png;base64,')) continue;
    fs.writeFileSync(path.join(folder, `${name}-${key}.png`), Buffer.from(value.slice(22), 'base64'));
    delete found[key];
  }
  fs.writeFileSync(path.join(folder, `${name}.json`), JSON.stringify(found, null, 1));
  console.log(JSON.stringify(found, null, 1));
  const holding = Object.entries({
    'it fails': found.failed !== undefined,
    'the console is told something': found.heard.length > 0,
    ...wrong,
  }).filter(([, holds]) => holds).map(([what]) => what);
  for (const what of holding) console.error(`${name}: ${what}`);
  process.exit(holding.length > 0 ? 1 : 0);
}
