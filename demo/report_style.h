// Style and script of the report's page.
#pragma once

namespace spanray::demo {

inline constexpr const char* kReportStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2024; --dim: #5b6570; --line: #d5dae0; --paper: #fff; --soft: #f4f6f8; --best: #b5367a; --other: #7b8794; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ec; --dim: #9aa5b1; --line: #3a424b; --paper: #15181b; --soft: #1f2429; --best: #ff7bb0; --other: #7b8794; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 0 auto; max-width: 1400px; padding: 0 24px 80px; }
h1 { margin: 28px 0 4px; } h2 { margin: 44px 0 8px; border-bottom: 1px solid var(--line); } h3 { margin: 24px 0 6px; }
p, ul { max-width: 82ch; } .dim { color: var(--dim); } code { font-size: 13px; overflow-wrap: anywhere; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13.5px; }
th, td { padding: 3px 6px; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th { background: var(--soft); vertical-align: bottom; font-weight: 600; white-space: normal; } td.text, th.text { text-align: left; white-space: normal; min-width: 150px; }
tr.group td { text-align: left; background: var(--soft); font-weight: 600; white-space: normal; } tr.group span { font-weight: 400; color: var(--dim); }
tr.plain td { font-weight: 600; } tr.pick { cursor: pointer; } tr.pick:hover td { background: var(--soft); }
.front { color: var(--best); font-weight: 600; } td.beaten { color: var(--dim); white-space: normal; min-width: 110px; } td.beaten, td.won { text-align: left; }
svg { width: 100%; height: auto; min-width: 620px; max-width: 900px; } svg text { fill: var(--dim); font-size: 13px; } svg .grid { stroke: var(--line); }
svg path.front { fill: none; stroke: var(--best); stroke-width: 1.5; } circle.best { fill: var(--best); } circle { cursor: pointer; }
circle.other { fill: var(--paper); stroke: var(--other); stroke-width: 2; } svg line.truth { stroke: var(--dim); stroke-dasharray: 6 4; } svg .number { fill: var(--best); font-weight: 700; }
.slider { position: relative; line-height: 0; cursor: ew-resize; touch-action: pan-y; user-select: none; }
.slider img { width: 100%; display: block; image-rendering: pixelated; }
.slider .over { position: absolute; inset: 0; } .slider .bar { position: absolute; top: 0; bottom: 0; width: 2px; background: #fff; mix-blend-mode: difference; }
input[type=range] { width: 100%; margin: 6px 0 0; } select { font: inherit; max-width: 340px; } .warn { border-left: 3px solid var(--best); padding-left: 12px; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 16px; } .pair img { width: 100%; } figure.map img { width: 100%; max-width: 900px; image-rendering: pixelated; } label { white-space: nowrap; } figure { margin: 8px 0; } figcaption { color: var(--dim); font-size: 13px; }
svg .leader { stroke: var(--best); stroke-width: 0.8; } svg .zero { stroke: var(--dim); stroke-dasharray: 1 3; } td.yes { color: var(--best); } @media print { tr.pick { cursor: auto; } }
)css";

// Where no script runs, nothing hides.
inline constexpr const char* kReportStyleWithoutScript = ".plot[hidden] { display: block !important; } .needs-script { display: none; }";

inline constexpr const char* kReportScript = R"js(
const by = id => document.getElementById(id);
function show() {
  const a = IMAGES[by('left').value], b = IMAGES[by('right').value];
  by('under').src = a.picture; by('over').src = b.picture;
  by('name-left').textContent = a.name; by('name-right').textContent = b.name;
  by('pair-picture').src = b.picture; by('pair-flip').src = b.flip || ''; by('pair-flip').hidden = !b.flip;
  by('pair-name').textContent = b.name;
  slide();
}
function slide() {
  const x = by('where').value;
  by('over').style.clipPath = `inset(0 0 0 ${x}%)`; by('bar').style.left = `calc(${x}% - 1px)`;
}
for (const side of ['left', 'right'])
  for (const id in IMAGES) by(side).add(new Option(IMAGES[id].name, id));
by('left').value = 'truth'; by('right').value = FIRST;
for (const id of ['left', 'right']) by(id).addEventListener('change', show);
by('where').addEventListener('input', slide);
const drag = e => {
  if (e.type === 'pointermove' && !(e.buttons & 1)) return;
  const box = by('slider').getBoundingClientRect();
  by('where').value = Math.max(0, Math.min(100, 100 * (e.clientX - box.left) / box.width));
  slide();
};
for (const kind of ['pointerdown', 'pointermove']) by('slider').addEventListener(kind, drag);
for (const e of document.querySelectorAll('[data-id]'))
  e.addEventListener('click', () => { by('right').value = e.dataset.id; show(); by('pictures').scrollIntoView({behavior: 'smooth'}); });
by('metric').addEventListener('change', () => { for (const p of document.querySelectorAll('.plot')) p.hidden = p.id !== 'plot-' + by('metric').value; });
show();
)js";

}  // namespace spanray::demo
