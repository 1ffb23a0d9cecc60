// The style of pages that stand alone: on a screen and on A4.
#pragma once

namespace topple::app {

inline constexpr const char* k_page_style = R"css(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 24px 28px 40px; max-width: 900px; background: #fff; color: #1c1f23;
  font: 14px/1.5 "Noto Sans", "Helvetica Neue", Arial, "Liberation Sans", "DejaVu Sans", sans-serif; }
html:lang(ja) body { line-break: strict; font-family: "Hiragino Sans", "Yu Gothic", Meiryo, "Noto Sans CJK JP", "IPAexGothic",
  "VL PGothic", sans-serif; }
header { border-bottom: 3px solid #12355b; padding-bottom: 10px; }
header p { margin: 0; color: #444; }
h1 { font-size: 23px; line-height: 1.25; margin: 2px 0 6px; }
h2 { font-size: 17px; margin: 26px 0 8px; padding-bottom: 3px; border-bottom: 1px solid #b8c0c8; break-after: avoid; }
h3 { font-size: 14px; margin: 16px 0 4px; break-after: avoid; }
p { margin: 6px 0; }
ul { margin: 6px 0; padding-left: 20px; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(140px, 1fr)); gap: 10px; margin: 12px 0; }
.figures div { border: 1px solid #9aa5b1; border-top: 3px solid #12355b; padding: 8px 10px; break-inside: avoid; }
.figures b { display: block; font-size: 21px; line-height: 1.2; }
.figures span { display: block; font-size: 12px; color: #333; }
.notice { border: 1.5px solid #1c1f23; padding: 7px 11px; margin: 12px 0; }
.verdict { font-size: 16px; }
.note { font-size: 12px; color: #444; }
figure { margin: 10px 0 14px; break-inside: avoid; }
figcaption { font-size: 12px; color: #333; }
svg.chart { display: block; width: 100%; height: auto; font-family: inherit; }
.halo { paint-order: stroke; stroke: #fff; stroke-width: 4px; }
.keys { display: flex; flex-wrap: wrap; gap: 2px 18px; padding-left: 62px; font-size: 12px; }
.keys svg { width: 46px; height: 16px; vertical-align: middle; margin-right: 5px; }
.pictures { display: grid; grid-template-columns: 1fr 1fr; gap: 10px; }
figure:has(> .pictures) { break-inside: auto; }
.pictures figure { margin: 0; }
.picture { position: relative; }
.picture img { width: 100%; display: block; border: 1px solid #b8c0c8; }
.picture span { position: absolute; transform: translate(-50%, -50%); font-size: 11px; line-height: 1.2; padding: 1px 5px;
  background: rgba(255, 255, 255, 0.86); border: 1px solid #555; }
.wide { overflow-x: auto; }
.short { break-inside: avoid; }
.short table.narrow { width: auto; min-width: 60%; }
table { border-collapse: collapse; width: 100%; margin: 8px 0; font-size: 13px; break-inside: auto; }
th, td { text-align: left; padding: 4px 8px; border-bottom: 1px solid #d5dae0; vertical-align: top; }
thead th { border-bottom: 1.5px solid #1c1f23; font-weight: 600; vertical-align: bottom; }
tr { break-inside: avoid; }
.numbers td, .numbers thead th + th { text-align: right; font-variant-numeric: tabular-nums; }
.numbers td, .numbers th:first-child { white-space: nowrap; }
.verdict-cell { display: inline-block; min-width: 6.2em; text-align: left; }
.settings th { width: 42%; font-weight: 400; }
.settings td { overflow-wrap: anywhere; }
.ways th, .ways tbody th { width: auto; }
.ways td { overflow-wrap: normal; }
footer { margin-top: 26px; padding-top: 6px; border-top: 1px solid #b8c0c8; font-size: 12px; color: #444; overflow-wrap: anywhere; }
@page { size: A4; margin: 14mm 14mm 16mm; }
@media print { body { padding: 0; max-width: none; font-size: 9.5pt; } .wide { overflow: visible; } table { font-size: 8.5pt; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)css";

}  // namespace topple::app
