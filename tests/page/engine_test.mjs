// Holds the engine of live pages against the program: who falls, and when, in scenes at fixed steps.
//   node engine_test.mjs ENGINE.js TOPPLE SCENES [--print]
// ENGINE.js: app/page/web/page_engine.js of its build. SCENES: folder of the built-in scenes. The engine adds and
// multiplies in two roundings where the program has one, so that hashes are its own; they stand in hashes.txt beside
// this file, which --print writes anew.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const [enginePath, topple, scenes, print] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));
const most = 1e-9; // s, between overturning times
// Those in which impacts before the fall are few: of many, rounding alone changes the next.
const cases = [
  ['paper-a', '1 ms', 4], ['paper-b', '1 ms', 4], ['cabinet', '1 ms', 6], ['near-fault', '1 ms', 5],
  ['wedged', '1 ms', 3], ['chair', '1 ms', 3], ['bookshelf', '1 ms', 4], ['wardrobe', '1 ms', 4],
  ['anchored', '0.5 ms', 4], ['refrigerator', '1 ms', 4],
];

const calls = fs.readFileSync(path.join(here, '../../app/page/web/engine_calls.js'), 'utf8');
const wrap = new Function(`${calls}\nreturn wrap;`)();
const Engine = createRequire(import.meta.url)(path.resolve(enginePath));
const module = await Engine({ wasmBinary: fs.readFileSync(enginePath.replace(/js$/, 'wasm')) });
const engine = wrap(module);

for (const record of fs.readdirSync(path.join(scenes, '../records')))
  if (/\.(AT2|EW|csv)$/.test(record)) engine.addFile(record, fs.readFileSync(path.join(scenes, '../records', record)));

function run(name, text) {
  engine.load(name, text, []);
  engine.parsed(module._page_start());
  while (!engine.parsed(module._page_advance(1000)).over);
  return engine.parsed(module._page_outcome());
}

// The scene at a fixed step, for so long.
function fixed(name, step, duration) {
  const text = fs.readFileSync(path.join(scenes, `${name}.toml`), 'utf8')
    .replace(/^(duration|time_step|tolerance) *=.*$/gm, '');
  const run = `[run]\nduration = ${duration}\ntime_step = "${step}"\n`;
  return text.includes('[run]') ? text.replace('[run]', () => run) : `${text}\n${run}`;
}

let wrong = 0;
function expect(holds, what) {
  if (holds) return;
  console.error(what);
  ++wrong;
}

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'topple-engine-'));
const hashes = [];
let falls = 0;
for (const [name, step, duration] of cases) {
  const text = fixed(name, step, duration);
  const file = path.join(folder, `${name}.toml`);
  fs.writeFileSync(file, text);
  const own = run(name, text);
  const native = JSON.parse(execFileSync(topple, ['run', file, '--quiet', '--json', '-'], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] })).bodies;
  expect(own.trouble === null, `${name}: ${own.trouble}`);
  expect(own.bodies.length === native.length, `${name}: has ${own.bodies.length} pieces, not ${native.length}`);
  own.bodies.forEach((body, b) => {
    const there = native[b].overturn_time_s;
    if (body.overturn_time_s !== null) ++falls;
    expect(body.name === native[b].name && (body.overturn_time_s === null) === (there === null) &&
      !(Math.abs(body.overturn_time_s - there) > most),
      `${name}, ${step}: ${body.name} overturns at ${body.overturn_time_s} s, in the program at ${there} s`);
  });
  hashes.push(`${name} ${step} ${own.hash}`);
}
expect(falls >= 5, `only ${falls} pieces fall: nothing is compared`);

// Who is hit, and when: of steps, not of the rows that a page keeps.
{
  const text = 'topple = 1\nfloor = {}\nplace = [{ name = "bed", at = [1, 0] }]\nrun = { duration = 2, time_step = "1 ms", output_rate = 7, settle = false }\n' +
    '[[block]]\nname = "box"\nsize = [0.3, 0.6, 1.5]\nmass = 60\ntilt = "14 deg"\n';
  const file = path.join(folder, 'hit.toml');
  fs.writeFileSync(file, text);
  const own = run('hit', text).hits;
  const native = JSON.parse(execFileSync(topple, ['run', file, '--quiet', '--json', '-'], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] })).ways[0].hit_by;
  expect(own.length === 1 && native.length === 1 && own[0].place === 0 && own[0].body === 0 &&
    Math.abs(own[0].time_s - native[0].time_s) <= most,
    `hits are ${JSON.stringify(own)}, in the program ${JSON.stringify(native)}`);
}

// A scene that cannot be understood says where, and a change out of range is refused in words.
const refused = (of) => { try { of(); return ''; } catch (error) { return error.message; } };
expect(/^bad\.toml:2:1: /.test(refused(() => engine.load('bad', 'topple = 1\nnonsense = 3\n', []))), 'a bad scene is not refused with its place');
expect(/does not hold the file missing\.csv/.test(refused(() => engine.load('lost',
  'topple = 1\n[[shake]]\ntype = "record"\nfiles = ["missing.csv"]\n', []))), 'a missing record is not named');

const known = path.join(here, 'hashes.txt');
const lines = `${hashes.join('\n')}\n`;
if (print === '--print') fs.writeFileSync(known, lines);
else expect(fs.readFileSync(known, 'utf8') === lines, `the engine's hashes are others than in ${known}:\n${lines}`);
fs.rmSync(folder, { recursive: true });
console.log(`${cases.length} runs, ${falls} falls, ${wrong} differences`);
process.exit(wrong > 0 ? 1 : 0);
