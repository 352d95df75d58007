// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// The style sheet of the page that `bench --report` writes. Colours of stages are told apart by
/// people who are colour-blind (after Okabe and Ito), on light and on dark.
inline constexpr const char* kBenchPageStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f6f4; --card: #ffffff; --ink: #1d1f23; --quiet: #62676f; --line: #dcdcd8;
  --splat: #0072b2; --composite: #e08a00; --warp: #009e73; --prepare: #9a9da3;
  --good: #00795a; --bad: #b3261e;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #121316; --card: #1b1d21; --ink: #e8e8e6; --quiet: #9ba0a8; --line: #33363c;
    --splat: #4ba3db; --composite: #f0a63a; --warp: #2fc79c; --prepare: #74787f;
    --good: #4fd1a5; --bad: #ff8a80;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 1160px; padding: 32px 24px 48px; background: var(--page);
  color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", Helvetica, Arial, sans-serif;
}
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 6px; font-weight: 650; }
h2 { font-size: 21px; line-height: 1.25; margin: 44px 0 4px; overflow-wrap: anywhere; }
h3 { font-size: 15px; margin: 0 0 10px; font-weight: 650; }
p { margin: 0; }
.quiet { color: var(--quiet); fill: var(--quiet); }
.methods, .trio { display: grid; gap: 14px; margin: 18px 0; }
.methods { grid-template-columns: repeat(auto-fit, minmax(210px, 1fr)); }
.trio { grid-template-columns: repeat(auto-fit, minmax(260px, 1fr)); }
figure, .card {
  margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 10px;
  overflow: hidden;
}
.card { padding: 16px 18px; margin: 14px 0; }
figure img { display: block; width: 100%; height: auto; background: #0d0e10; }
figcaption { padding: 10px 14px 12px; }
figcaption b { font-weight: 650; }
.big { font-size: 25px; line-height: 1.2; font-weight: 650; font-variant-numeric: tabular-nums; }
.big span { font-size: 15px; font-weight: 400; color: var(--quiet); }
.verdict { font-weight: 650; }
.same { color: var(--good); }
.different { color: var(--bad); }
.legend { display: flex; flex-wrap: wrap; gap: 4px 18px; margin-bottom: 6px; }
.legend i {
  display: inline-block; width: 11px; height: 11px; border-radius: 2px; margin-right: 6px;
}
i.splat { background: var(--splat); } i.composite { background: var(--composite); }
i.warp { background: var(--warp); } i.prepare { background: var(--prepare); }
.bars {
  display: block; width: 100%; height: auto; font: 13px system-ui, Helvetica, Arial, sans-serif;
}
.bars text { fill: var(--ink); font-variant-numeric: tabular-nums; }
.bars text.quiet { fill: var(--quiet); }
.bars .rule { stroke: var(--line); fill: none; }
.bars .splat { fill: var(--splat); } .bars .composite { fill: var(--composite); }
.bars .warp { fill: var(--warp); } .bars .prepare { fill: var(--prepare); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; }
th { color: var(--quiet); font-weight: 500; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
tbody tr { border-top: 1px solid var(--line); }
.heat { height: 14px; border-radius: 3px; margin: 8px 0 2px; }
.ticks { display: flex; justify-content: space-between; font-variant-numeric: tabular-nums; }
code { font: 13px ui-monospace, "SF Mono", Menlo, Consolas, monospace; overflow-wrap: anywhere; }
footer { margin-top: 40px; border-top: 1px solid var(--line); padding-top: 14px; }
@media print { body { max-width: none; } figure, .card { break-inside: avoid; } }
)css";

}  // namespace deltasplat
