// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// What the style sheets of all pages begin with that the program writes, for light and for dark.
inline constexpr const char* kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f6f4; --card: #ffffff; --ink: #1d1f23; --quiet: #62676f; --line: #dcdcd8;
  --good: #00795a; --bad: #b3261e; --dark: #0d0e10;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #121316; --card: #1b1d21; --ink: #e8e8e6; --quiet: #9ba0a8; --line: #33363c;
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
figure, .card {
  margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 10px;
  overflow: hidden;
}
.card { padding: 16px 18px; margin: 14px 0; }
figure img { display: block; width: 100%; height: auto; background: var(--dark); }
figcaption { padding: 10px 14px 12px; }
figcaption b { font-weight: 650; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; }
th { color: var(--quiet); font-weight: 500; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
tbody tr { border-top: 1px solid var(--line); }
code { font: 13px ui-monospace, "SF Mono", Menlo, Consolas, monospace; overflow-wrap: anywhere; }
footer { margin-top: 40px; border-top: 1px solid var(--line); padding-top: 14px; }
@media print { body { max-width: none; } figure, .card { break-inside: avoid; } }
)css";

}  // namespace deltasplat
