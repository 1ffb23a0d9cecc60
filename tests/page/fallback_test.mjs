// What a browser shows of a live page that cannot draw it, or not compute it: still pictures and words.
//   node fallback_test.mjs chromium|firefox PAGE.html FOLDER webgl2|worker|wasm|gpu
// The last is what the browser has not: the first three are taken away by a script, gpu by Chromium's options.
import { openPage, report } from './open_page.mjs';

const [browser, page, folder, missing] = process.argv.slice(2);

const before = {
  webgl2: `{
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...of) {
      return kind === 'webgl2' ? null : get.call(this, kind, ...of);
    };
  }`,
  worker: 'delete window.Worker;',
  wasm: 'delete window.WebAssembly;',
  gpu: '',
}[missing];
const dead = missing === 'worker' || missing === 'wasm';

const act = `
  await until(() => visible('stills'), 'the stills');
  await frame();
  const stills = [...document.querySelectorAll('#stills img')];
  for (const image of stills) await image.decode();
  found.sizes = stills.map((image) => [image.naturalWidth, image.naturalHeight, Math.sign(image.clientHeight)]);
  found.colours = stills.map((image) => {
    const copy = Object.assign(document.createElement('canvas'), { width: image.naturalWidth, height: image.naturalHeight });
    const brush = copy.getContext('2d');
    brush.drawImage(image, 0, 0);
    return new Set(new Uint32Array(brush.getImageData(0, 0, copy.width, copy.height).data.buffer)).size;
  });
  found.different = new Set(stills.map((image) => image.src)).size;
  found.unnamed = unnamed();
  found.empty = [...document.querySelectorAll('h2, label, p, button')].filter((one) =>
    one.getClientRects().length > 0 && !one.textContent.trim()).length;
  found.canvas = visible('picture');
  found.views = visible('views');
  found.verdict = visible('verdict') && text('verdict');
  found.of_bodies = data.bodies.filter((body) => body.overturn_time_s !== null)
    .every((body) => found.verdict.includes(body.name) && found.verdict.includes(body.overturn_time_s.toFixed(2)));
  found.falls = data.bodies.filter((body) => body.overturn_time_s !== null).length;
  found.only = text('only');
  found.notice = visible('nopicture') && text('nopicture');
  found.controls = visible('controls');
  found.transport = visible('transport');
  found.trouble = text('trouble');
  if (found.controls) {
    move(slider('.amplitude'), 0.02);
    await until(() => page.changed, 'the run');
    found.gentle = text('verdict');
    document.getElementById('language').click();
    found.other_notice = text('nopicture');
  }
`;

const found = await openPage({ browser, page, act, before, ...(missing === 'gpu' && { flags: ['--disable-gpu', '--disable-3d-apis'] }) });
report(found, folder, `${browser}-without-${missing}`, {
  'it has no three still pictures': !(found.sizes && found.sizes.length === 3 &&
    found.sizes.every(([width, height, shown]) => width === 640 && height === 400 && shown === 1)),
  'a still picture is empty': !(found.colours && found.colours.every((count) => count > 100)),
  'the pictures are all the same': !(found.different > 1),
  'it does not say who falls': !(found.falls > 0 && found.of_bodies),
  'a control has no name': found.unnamed !== 0,
  'it shows something empty': found.empty !== 0,
  'it shows a canvas that nothing draws on': found.canvas !== false || found.views !== false,
  'it shows trouble': Boolean(found.trouble),
  'it does not say what the browser lacks': !(dead ? found.only.includes('Worker') : String(found.notice).includes('WebGL2')),
  'what cannot compute has sliders': dead && (found.controls || found.transport),
  'what can compute has none': !dead && !(found.controls && found.transport),
  'a gentle shake says the same': !dead && (!found.gentle || found.gentle === found.verdict),
  'the other language says the same': !dead && (!found.other_notice || found.other_notice === found.notice),
});
