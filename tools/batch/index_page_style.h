// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// What the style sheet of a batch's index adds to kPageStyle.
inline constexpr const char* kIndexPageStyle = R"css(
body { max-width: 1720px; }
header { display: flex; flex-wrap: wrap; gap: 8px 24px; align-items: end; }
header div { flex: 1 1 320px; }
h1 { overflow-wrap: anywhere; }
#filter {
  font: inherit; color: inherit; background: var(--card); border: 1px solid var(--line);
  border-radius: 8px; padding: 7px 12px; width: min(300px, 100%);
}
a { color: inherit; }
.failed, .failed a { color: var(--bad); }
.pictures {
  display: grid; gap: 14px; margin: 22px 0; align-items: start;
  grid-template-columns: repeat(auto-fill, minmax(208px, 1fr));
}
figure img, .none { aspect-ratio: var(--shape); object-fit: contain; background: var(--dark); }
.none { display: grid; place-items: center; color: #9ba0a8; }
figcaption { padding: 9px 12px 11px; overflow-wrap: anywhere; line-height: 1.35; }
figcaption .quiet { font-size: 13px; font-variant-numeric: tabular-nums; }
#failures td:first-child { min-width: 18em; }
#failures td { text-align: left; white-space: normal; overflow-wrap: anywhere; vertical-align: top; }
#failures th { text-align: left; }
)css";

/// Lets a field filter what is on the page; without scripts there is no field.
inline constexpr const char* kIndexPageScript = R"js(
(() => {
  const field = document.getElementById("filter");
  const items = [...document.querySelectorAll("figure, #failures tbody tr")];
  const words = items.map(item => item.textContent.toLowerCase());
  field.hidden = false;
  field.addEventListener("input", () => {
    const wanted = field.value.toLowerCase().split(/\s+/);
    items.forEach((item, i) => { item.hidden = !wanted.every(word => words[i].includes(word)); });
  });
})();
)js";

}  // namespace deltasplat
