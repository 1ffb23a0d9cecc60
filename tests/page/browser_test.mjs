// Does with a live page in a browser what its reader does, and looks at what becomes of it:
//   node browser_test.mjs chromium|firefox PAGE.html FOLDER [WIDTH HEIGHT]
// Its findings and pictures of its canvases go to FOLDER.
import { openPage, report } from './open_page.mjs';

const [browser, page, folder, width = '1280', height = '900'] = process.argv.slice(2);

const act = `
  const picture = () => { drawPicture(); return document.getElementById('picture').toDataURL(); };
  const chart = () => document.getElementById('chart').toDataURL();
  await until(() => document.documentElement.dataset.ready === 'true', 'the page');
  await frame();
  found.title = text('title');
  found.verdict = text('verdict');
  found.recorded = text('source');
  found.replay_only = text('only');
  found.controls = visible('controls') ? document.querySelectorAll('#controls input').length : 0;
  found.unnamed = unnamed();
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
  await until(() => Number(document.getElementById('time').value) > found.timeline_seeks, 'the play');
  found.space_plays = Number(document.getElementById('time').value) - found.timeline_seeks;
  if (page.playing) key(document.body, ' ');
  await frame();
  document.querySelector('[data-view="3"]').click();
  if (data.live) {
    await until(() => page.mapped, 'the map');
    found.map_before = chart();
    found.no_map = text('nomap');
    found.pieces = visible('pieces') ? document.querySelectorAll('#piece option').length : 1;
    const amplitude = slider('.amplitude');
    if (amplitude) {
      move(amplitude, 0.02);
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
    const choice = document.getElementById('piece');
    if (found.pieces > 1) {
      page.mapped = null;
      choice.value = found.pieces - 1;
      choice.dispatchEvent(new Event('change', { bubbles: true }));
      await until(() => page.mapped, 'the map of another piece');
      found.map_after = chart();
      found.map_follows = document.getElementById('chart').getAttribute('aria-label').endsWith(page.names[found.pieces - 1]);
      found.map_differs = found.map_after !== found.map_before;
      const own = page.controls.findIndex((control) => control.body === 0 && control.kind === 'number');
      if (own >= 0) {
        move(document.getElementById('control-' + own), 0.4);
        found.slider_chooses = choice.value === '0';
        await until(() => page.changed, 'the run of a changed piece');
        document.getElementById('back').click();
      }
    }
    found.no_map = text('nomap');
    const follower = page.controls.findIndex((control) => control.follows >= 0);
    if (follower >= 0) {
      const { follows: followed, share } = page.controls[follower];
      const shown = (i) => document.querySelector('output[for="control-' + i + '"]').textContent.trim();
      const before = shown(followed);
      move(document.getElementById('control-' + followed), 0.1);
      found.follows = shown(followed) !== before && page.values[follower] === share * page.values[followed];
      await until(() => page.changed, 'the run of another friction');
      document.getElementById('back').click();
    }
  }
  document.getElementById('language').click();
  await frame();
  found.japanese = text('verdict');
  found.other_replay_only = text('only');
  found.other_no_map = text('nomap');
  found.lang = document.documentElement.lang;
  document.getElementById('dark').click(); document.getElementById('projector').click();
  await frame();
  found.dark = picture();
  found.timeline = timeline.toDataURL();
  found.trouble = text('trouble');
  found.still_wide = document.documentElement.scrollWidth > innerWidth;
  found.live = data.live;
`;

const found = await openPage({ browser, page, act, size: [width, height] });
const { live } = found;
const asian = /[\u3040-\u30ff\u4e00-\u9fff]/;
report(found, folder, browser, {
  'it does not say who falls': !found.verdict,
  'a control has no name': found.unnamed !== 0,
  'it is wider than the screen': found.wider_than_screen || found.still_wide,
  'it draws nothing': found.drawn !== true,
  'a drag turns nothing': found.drag_turns !== true,
  'two fingers zoom nothing': found.touch_zooms !== true,
  'an arrow key turns nothing': found.key_turns !== true,
  'the timeline does not seek': !(Math.abs(found.timeline_seeks / found.last - 0.5) < 0.02),
  'Space does not play': !(found.space_plays > 0),
  'the other language says the same': found.japanese === found.verdict,
  'it shows trouble': Boolean(found.trouble),
  'a live page has no controls': live && !(found.controls > 0),
  'a live page says that it replays only': live && found.replay_only !== '',
  'a page that replays only has controls': !live && found.controls > 0,
  'a page does not say in both languages that it replays only':
    !live && asian.test(found.replay_only) === asian.test(found.other_replay_only),
  'a gentle shake says the same': live && found.gentle !== undefined && found.gentle === found.verdict,
  'the way back says something else': live && found.back !== found.verdict,
  'the map does not follow the piece that is chosen': live && found.pieces > 1 && found.map_follows !== true,
  'a slider of a piece does not choose it': live && found.slider_chooses === false,
  'a slider does not follow the one that it follows': found.follows === false,
  'why there is no map is not said in both languages':
    live && Boolean(found.no_map) && asian.test(found.no_map) === asian.test(found.other_no_map),
});
