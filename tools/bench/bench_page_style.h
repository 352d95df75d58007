// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// What the style sheet of the page that `bench --report` writes adds to kPageStyle. Colours of
/// stages are told apart by people who are colour-blind (after Okabe and Ito), on light and on
/// dark.
inline constexpr const char* kBenchPageStyle = R"css(
:root { --splat: #0072b2; --composite: #e08a00; --warp: #009e73; --prepare: #9a9da3; }
@media (prefers-color-scheme: dark) {
  :root { --splat: #4ba3db; --composite: #f0a63a; --warp: #2fc79c; --prepare: #74787f; }
}
.methods, .trio { display: grid; gap: 14px; margin: 18px 0; }
.methods { grid-template-columns: repeat(auto-fit, minmax(210px, 1fr)); }
.trio { grid-template-columns: repeat(auto-fit, minmax(260px, 1fr)); }
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
.heat { height: 14px; border-radius: 3px; margin: 8px 0 2px; }
.ticks { display: flex; justify-content: space-between; font-variant-numeric: tabular-nums; }
)css";

}  // namespace deltasplat
