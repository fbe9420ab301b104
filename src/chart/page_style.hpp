// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kelpie::chart {

/// The page around the figures.
inline constexpr std::string_view kPageStyle = R"(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1c2126; --faint: #5a646e;
  --edge: #d5dade; --warn: #fdf0d9; --warn-edge: #d55e00; }
@media (prefers-color-scheme: dark) { :root { --paper: #15191d; --ink: #e6e9ec; --faint: #a3adb6;
  --edge: #39424a; --warn: #3a2a14; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1rem 3rem; max-width: 76rem; background: var(--paper);
  color: var(--ink); line-height: 1.5;
  font: 1rem/1.5 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .5rem; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .4rem; padding-top: .6rem;
  border-top: 1px solid var(--edge); }
h3 { font-size: 1rem; margin: .6rem 0 .2rem; overflow-wrap: anywhere; }
p { margin: .3rem 0 .7rem; max-width: 46rem; overflow-wrap: anywhere; }
.lead { font-size: 1.1rem; }
.note, figcaption { color: var(--faint); font-size: .875rem; }
.interrupted { border-left: 5px solid var(--warn-edge); background: var(--warn);
  padding: .6rem .9rem; }
figure { margin: 0; min-width: 0; }
figcaption { margin: .2rem 0 .6rem; }
.grid-panels { display: grid; gap: 1rem 1.5rem; align-items: end;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 21rem), 1fr)); }
.pair { display: grid; gap: 1rem 1.5rem; align-items: start;
  grid-template-columns: minmax(0, 2.1fr) minmax(0, 1fr); }
.narrow { display: none; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .5rem; text-align: right; border-bottom: 1px solid var(--edge);
  white-space: nowrap; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
.facts th { font-weight: 500; vertical-align: top; }
.facts td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
.words td { white-space: normal; text-align: left; min-width: 6rem; vertical-align: top; }
.words th { text-align: left; }
.verdict { font-weight: 600; white-space: nowrap; }
.holds { color: #0072b2; } .part { color: #b07000; } .fails { color: #d55e00; }
.bad { font-weight: 700; color: #d55e00; }
@media screen and (max-width: 45rem) { .wide { display: none; } .narrow { display: block; }
  .pair { grid-template-columns: minmax(0, 1fr); } }
@media print { body { max-width: none; padding: 0; font-size: 10pt; }
  .grid-panels, .pair { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .wide { display: none; } .narrow { display: block; max-width: 30rem; }
  figure, tr { break-inside: avoid; } h2, h3 { break-after: avoid; }
  .scroll { overflow: visible; } .scroll table { font-size: 6.5pt; }
  .scroll th, .scroll td { padding: .15rem .25rem; } }
)";

}  // namespace kelpie::chart
