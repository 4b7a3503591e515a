// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adasplats::page {

/// The style sheet of the page: classes of html_page.cpp and chart.cpp, for light and dark.
// Series colours: at least 4:1 against the page in both schemes, and the first seven apart in
// lightness too, so that they differ for protanopes and deuteranopes; markers say the rest.
inline constexpr const char* kPageStyle = R"css(
:root{color-scheme:light dark;--page:#fff;--soft:#f4f6f8;--text:#1b2129;--dim:#59636e;
--rule:#d9dee3;
--grid:#e6eaee;--accent:#0b5cad;--warn:#9a3412;--warnbg:#fdeee6;
--c0:#1673d6;--c1:#c06000;--c2:#0d8a68;--c3:#8a1f80;--c4:#20262d;--c5:#6b3000;--c6:#2b2bb8;
--c7:#b3261e}
@media(prefers-color-scheme:dark){:root{--page:#14181d;--soft:#1d232a;--text:#e6eaee;--dim:#9ba7b4;
--rule:#333c46;--grid:#2a323b;--accent:#7cb7ff;--warn:#ffb08a;--warnbg:#3a2318;
--c0:#7fa6ff;--c1:#ee7536;--c2:#62eaa5;--c3:#c56a97;--c4:#eef3f8;--c5:#f2e04a;--c6:#8a72ff;
--c7:#ff5d55}}
*{box-sizing:border-box}
html{scroll-behavior:smooth}
body{margin:0;background:var(--page);color:var(--text);
font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main,header,footer{max-width:1240px;margin:0 auto;padding:0 28px}
header{padding-top:44px}
h1{font-size:2.1rem;line-height:1.2;letter-spacing:-.015em;margin:0 0 8px}
.subtitle{color:var(--dim);font-size:1.08rem;margin:0 0 18px;max-width:none}
nav{display:flex;flex-wrap:wrap;gap:4px 20px;padding:12px 0;border-top:1px solid var(--rule);
border-bottom:1px solid var(--rule);font-size:.92rem}
a{color:var(--accent);text-decoration:none}a:hover{text-decoration:underline}
section{margin:44px 0 0}
h2{font-size:1.42rem;letter-spacing:-.01em;line-height:1.25;margin:0 0 12px}
h3{font-size:1.02rem;margin:26px 0 8px}
p{max-width:78ch;margin:0 0 12px}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:5px 22px;margin:0 0 16px;
max-width:110ch}
.facts dt{color:var(--dim)}.facts dd{margin:0;overflow-wrap:anywhere}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(250px,1fr));gap:14px;margin:0}
.tiles div{background:var(--soft);border-radius:8px;padding:14px 16px}
.tiles dt{color:var(--dim);font-size:.86rem;line-height:1.35}
.tiles dd{margin:6px 0 0;font-size:.95rem;white-space:pre-line;line-height:1.4}
.tiles dd::first-line{font-size:1.5rem;font-weight:650}
.scroll{overflow-x:auto;border:1px solid var(--rule);border-radius:8px;max-width:100%}
table{border-collapse:collapse;width:100%;font-size:.9rem;font-variant-numeric:tabular-nums}
th,td{padding:7px 12px;text-align:right;white-space:nowrap;border-top:1px solid var(--rule)}
thead th{white-space:normal;border-top:0;background:var(--soft);font-weight:600;color:var(--dim);
vertical-align:bottom}
thead tr+tr th{padding-top:0;font-weight:400}
th.group{text-align:center;padding-bottom:2px}
tbody th,thead tr:first-child>th:first-child{text-align:left;position:sticky;left:0;z-index:1}
tbody th{background:var(--page);font-weight:500}
tbody tr:hover>*{background:var(--soft)}
.text{text-align:left;white-space:normal;min-width:8ch}
.paper{color:var(--dim)}
td b{font-weight:750}
td small{display:block;color:var(--dim);font-size:.76rem;line-height:1.2}
.badge{display:inline-block;margin-left:8px;padding:0 8px;border-radius:9px;font-size:.76rem;
background:var(--soft);color:var(--dim);font-weight:500}
.badge.bad{background:var(--warnbg);color:var(--warn)}
.key{width:12px;height:12px;margin-right:8px;vertical-align:-1px}
.defs{font-size:.88rem;color:var(--dim);margin:10px 0 0;max-width:100ch}
.defs div{margin:0 0 3px}.defs dt{display:inline;font-weight:600;color:var(--text)}
.defs dt::after{content:": "}.defs dd{display:inline;margin:0}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,500px),1fr));
gap:30px 36px;margin:28px 0 0;align-items:start}
figure{margin:0;min-width:0}
.chart svg{display:block;width:100%;min-width:430px;max-width:680px;height:auto;overflow:visible}
.chart .box{overflow-x:auto;padding:2px 2px 4px}
svg text{font:12px system-ui,-apple-system,"Segoe UI",Roboto,Arial,sans-serif;fill:var(--text)}
svg .title{font-size:14.5px;font-weight:650}svg .tick{fill:var(--dim);font-size:11.5px}
svg .small{fill:var(--dim);font-size:11px}svg .middle{text-anchor:middle}svg .end{text-anchor:end}
.grid{stroke:var(--grid)}.axis{stroke:var(--dim)}
.line{fill:none;stroke:var(--c);stroke-width:2;stroke-linejoin:round}.dash{stroke-dasharray:5 4}
.mark{fill:var(--c);stroke:var(--page);stroke-width:1}
.mark.open{fill:var(--page);stroke:var(--c);stroke-width:1.7}
.bar{fill:var(--c)}.bar.open{fill-opacity:.28;stroke:var(--c)}
.s0{--c:var(--c0)}.s1{--c:var(--c1)}.s2{--c:var(--c2)}.s3{--c:var(--c3)}
.s4{--c:var(--c4)}.s5{--c:var(--c5)}.s6{--c:var(--c6)}.s7{--c:var(--c7)}
details{margin:6px 0 0;font-size:.92rem}summary{cursor:pointer;color:var(--accent);font-size:.86rem}
details[open] summary{margin-bottom:8px}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,370px),1fr));gap:20px}
.pictures figure:only-child{grid-column:1/-1}
.pictures img{display:block;width:100%;height:auto;border-radius:6px;border:1px solid var(--rule);
cursor:zoom-in}
.pictures figcaption{font-size:.9rem;margin:0 0 6px;font-weight:500}
.pictures .missing{color:var(--dim);border:1px dashed var(--rule);border-radius:6px;padding:24px;
margin:0;overflow-wrap:anywhere}
.zoom input{position:absolute;opacity:0}
.zoom input:focus-visible+img{outline:3px solid var(--accent)}
.zoom input:checked+img{position:fixed;inset:0;z-index:9;width:100vw;height:100vh;
object-fit:contain;
background:var(--page);border:0;border-radius:0;cursor:zoom-out}
.scale{display:flex;flex-wrap:wrap;align-items:center;gap:8px 12px;margin:0 0 16px;font-size:.88rem;
color:var(--dim)}
.scale i{display:block;width:240px;height:12px;border-radius:3px}
pre{background:var(--soft);border-radius:8px;padding:11px 14px;margin:0 0 12px;font-size:.84rem;
line-height:1.5;white-space:pre-wrap;overflow-wrap:anywhere;
font-family:ui-monospace,"SF Mono",Menlo,Consolas,"DejaVu Sans Mono",monospace}
.command{font-size:.88rem;margin:0 0 4px;color:var(--dim)}
footer{color:var(--dim);font-size:.86rem;padding-top:36px;padding-bottom:44px}
@media(max-width:640px){main,header,footer{padding-left:16px;padding-right:16px}
h1{font-size:1.6rem}.facts{grid-template-columns:1fr;gap:0}.facts dd{margin-bottom:8px}}
@media print{nav,summary{display:none}.scroll{overflow:visible}section,figure{break-inside:avoid}}
)css";

}  // namespace adasplats::page
