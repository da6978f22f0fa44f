"""The explorer's page: its styles, its small script, and the HTML of its parts.

The page keeps no state. Everything that is moved, typed or pressed goes to Python through one hidden text box, as a list
of numbered events; Python answers with new HTML, and with the values of all inputs as JSON, which the script copies into
the inputs unless newer events are still under way.
"""
from __future__ import annotations

import html

from .inputs import COEFFICIENTS, DEMANDS, DESIGN, MISSION, NUMBERS, SEARCH, SOIL, VIEWS

STYLE = """
.rdk-explorer {--rdk-page:#f3f5f8; --rdk-card:#fff; --rdk-ink:#1a2230; --rdk-quiet:#505b73; --rdk-line:#d5dbe5;
  --rdk-edge:#7b8698; --rdk-blue:#0b5cab; --rdk-on:#fff; --rdk-hot:#eef5fc; --rdk-bar:#e3e8f0; --rdk-span:#86b6e4;
  --rdk-red:#b42318; --rdk-green:#067647; --rdk-amber:#8a4b08; --rdk-bad:#fff4f2; --rdk-good:#effaf4; --rdk-risk:#fff8eb;
  font:13px/1.35 system-ui,"Segoe UI","DejaVu Sans",sans-serif; color:var(--rdk-ink); background:var(--rdk-page);
  container-type:inline-size; padding:0 0 12px; overflow:visible !important; margin:0}
DARK {--rdk-page:#12161d; --rdk-card:#1b212b; --rdk-ink:#e8ecf3; --rdk-quiet:#aeb8c8;
  --rdk-line:#39424f; --rdk-edge:#8390a3; --rdk-blue:#7db8f5; --rdk-on:#0d1219; --rdk-hot:#232d3b; --rdk-bar:#323b48;
  --rdk-span:#3f6f9f; --rdk-red:#ff9e92; --rdk-green:#63d297; --rdk-amber:#f2b45c; --rdk-bad:#33201f; --rdk-good:#18291f;
  --rdk-risk:#332a18; --rdk-c0:#6cb2f0; --rdk-c1:#f39a5b; --rdk-c2:#4fc79e; --rdk-part:#2c3643; --rdk-soil:#37332d}
.rdk-explorer .widget-html, .rdk-explorer .rdk-grid > * {margin:0; min-width:0; height:auto; overflow:visible; padding:0; width:auto}
.rdk-explorer [hidden] {display:none !important} .rdk-explorer {position:relative}
.rdk-explorer .widget-html-content {color:var(--rdk-ink); font:inherit; line-height:1.35; width:100%; min-width:0; padding:0}
.rdk-explorer .rdk-grid {display:grid; gap:10px 12px; grid-template-columns:316px minmax(0,1fr) 318px;
  grid-template-areas:"top top top" "left verdict verdict" "left views side" "left picture side" "left tray tray";
  grid-template-rows:auto auto auto 1fr auto; overflow:visible}
.rdk-top {grid-area:top} .rdk-left {grid-area:left} .rdk-verdict {grid-area:verdict} .rdk-views {grid-area:views}
.rdk-picture {grid-area:picture} .rdk-side {grid-area:side} .rdk-tray {grid-area:tray}
.rdk-explorer .rdk-left {margin-left:12px !important} .rdk-explorer :is(.rdk-verdict,.rdk-tray,.rdk-side) {margin-right:12px !important}
.rdk-explorer .rdk-drawer {position:absolute; right:12px; top:54px; z-index:8; width:min(680px,100% - 24px); box-sizing:border-box; box-shadow:0 6px 20px #0005} .rdk-explorer .rdk-drawer:not(:has(div div, section)) {display:none}
.rdk-explorer :is(.rdk-left,.rdk-views,.rdk-picture,.rdk-side,.rdk-tray,.rdk-drawer) {background:var(--rdk-card);
  border:1px solid var(--rdk-line); border-radius:8px; padding:8px 12px}
.rdk-explorer .rdk-views {border-bottom:0; border-radius:8px 8px 0 0; margin-bottom:-10px !important; padding-bottom:2px}
.rdk-explorer .rdk-picture {border-top:0; border-radius:0 0 8px 8px; padding-top:4px; min-height:280px}
.rdk-explorer .rdk-bridge, .rdk-explorer .rdk-data {display:none} .rdk-explorer .jupyter-widgets-disconnected::before, .rdk-explorer.jupyter-widgets-disconnected::before {content:none}
.rdk-explorer :is(button,summary,select,input) {font:inherit; color:inherit}
.rdk-explorer button, .rdk-explorer summary {cursor:pointer} .rdk-explorer :is(p,h2,h3,ul) {margin:0; padding:0}
.rdk-explorer :is(button,input,select,summary,a,[tabindex]):focus-visible {outline:3px solid #d55e00; outline-offset:1px}
.rdk-explorer .rdk-btn {background:var(--rdk-card); border:1px solid var(--rdk-edge); border-radius:5px; padding:3px 9px}
.rdk-explorer button:disabled {opacity:.45; cursor:default} .rdk-explorer .rdk-main {background:var(--rdk-blue); color:var(--rdk-on)}
.rdk-explorer .rdk-bar {background:#14213d; color:#fff; display:flex; align-items:center; flex-wrap:wrap; gap:4px 12px; min-height:48px; padding:4px 16px}
.rdk-bar h2 {font-size:15px; color:#fff} .rdk-bar .q {opacity:.85; flex:1} .rdk-explorer .rdk-bar :is(button,summary) {background:none;
  color:#fff; border:1px solid #7a89ab; border-radius:5px; padding:4px 9px; list-style:none} .rdk-bar details {position:relative}
.rdk-bar details div {position:absolute; right:0; top:32px; z-index:9; background:#14213d; border:1px solid #7a89ab; border-radius:5px;
  padding:6px; display:grid; gap:4px; min-width:150px} .rdk-skip {position:absolute; left:-999px} .rdk-bar .rdk-skip:focus {position:static; color:#fff}
.rdk-explorer [role=tablist] {display:flex; flex-wrap:wrap; border-bottom:1px solid var(--rdk-line); margin-bottom:6px}
.rdk-explorer [role=tab] {background:none; border:0; padding:6px 9px; color:var(--rdk-quiet)}
.rdk-explorer [role=tab][aria-selected=true] {color:var(--rdk-blue); font-weight:600; box-shadow:inset 0 -3px var(--rdk-blue)}
.rdk-explorer h3 {margin:8px 0 1px; font-size:11px; font-weight:600; text-transform:uppercase; letter-spacing:.06em; color:var(--rdk-quiet)}
.rdk-row {display:grid; grid-template-columns:78px minmax(60px,1fr) 48px 32px; align-items:center; gap:5px; min-height:31px; position:relative}
.rdk-row:focus-within {background:var(--rdk-hot)} .rdk-explorer .rdk-left {padding:8px 10px 8px 24px}
.rdk-row .u {color:var(--rdk-quiet); font-size:12px} .rdk-explorer .rdk-box {width:100%; box-sizing:border-box; text-align:right; background:var(--rdk-card);
  border:1px solid var(--rdk-edge); border-radius:4px; padding:2px 4px; font-variant-numeric:tabular-nums}
.rdk-explorer .rdk-back {border:0; background:none; padding:0; width:24px; height:26px; position:absolute; left:-25px; top:2px; color:var(--rdk-blue); font-size:15px}
.rdk-help summary {list-style:none; line-height:1.15; min-height:24px; display:flex; align-items:center; gap:4px}
.rdk-help i {font:10px system-ui; border:1px solid var(--rdk-edge); color:var(--rdk-quiet); border-radius:50%; min-width:13px; line-height:13px; text-align:center} .rdk-help summary::-webkit-details-marker {display:none}
.rdk-help p {position:absolute; left:0; right:0; top:29px; z-index:5; background:var(--rdk-card); border:1px solid var(--rdk-edge); border-radius:5px;
  padding:7px 9px; box-shadow:0 4px 14px #0004}
.rdk-slide {position:relative; display:block; height:28px} .rdk-slide i {position:absolute; top:4px; width:2px; height:20px; background:var(--rdk-ink);
  left:calc(9px + var(--at)*(100% - 18px)/100 - 1px); pointer-events:none}
.rdk-explorer input[type=range] {appearance:none; position:absolute; inset:0; width:100%; height:28px; margin:0; background:none}
.rdk-explorer input[type=range]::-webkit-slider-runnable-track {height:4px; border-radius:2px; background:var(--rdk-edge)}
.rdk-explorer input[type=range]::-moz-range-track {height:4px; border-radius:2px; background:var(--rdk-edge)}
.rdk-explorer input[type=range]::-webkit-slider-thumb {appearance:none; width:18px; height:18px; margin-top:-7px; border-radius:50%; background:var(--rdk-blue);
  border:2px solid var(--rdk-card); box-shadow:0 0 0 1px var(--rdk-blue)}
.rdk-explorer input[type=range]::-moz-range-thumb {width:14px; height:14px; border-radius:50%; background:var(--rdk-blue); border:2px solid var(--rdk-card)}
.rdk-explorer select {background:var(--rdk-card); border:1px solid var(--rdk-edge); border-radius:5px; padding:4px 6px; max-width:100%}
.rdk-menu {display:grid; grid-template-columns:auto 1fr; gap:8px; align-items:center; margin:3px 0} .rdk-menu select {width:100%; font-weight:600; min-width:0}
.rdk-sole {display:block} .rdk-seg {display:flex; border:1px solid var(--rdk-edge); border-radius:5px; overflow:hidden; margin:3px 0} .rdk-explorer .rdk-seg button {flex:1; border:0; background:none; padding:4px 8px}
.rdk-explorer .rdk-seg button[aria-pressed=true] {background:var(--rdk-blue); color:var(--rdk-on); font-weight:600}
.rdk-say {color:var(--rdk-quiet); font-size:12px} .rdk-more > summary {color:var(--rdk-blue); padding:5px 0}
.rdk-say1 {border-left:5px solid var(--rdk-tone); background:var(--rdk-back); border-radius:8px; padding:7px 12px; min-height:46px}
.rdk-say1 b {font-size:15px} .rdk-explorer .rdk-say1 button {background:none; border:1px solid var(--rdk-edge); border-radius:10px; padding:0 7px; margin-left:2px; min-height:24px}
.rdk-met {--rdk-tone:var(--rdk-green); --rdk-back:var(--rdk-good)} .rdk-missed {--rdk-tone:var(--rdk-red); --rdk-back:var(--rdk-bad)}
.rdk-risk {--rdk-tone:var(--rdk-amber); --rdk-back:var(--rdk-risk)} .rdk-none {--rdk-tone:var(--rdk-line); --rdk-back:var(--rdk-card)}
.rdk-cards {display:grid; grid-template-columns:repeat(5,1fr); gap:8px; margin-top:8px} .rdk-card {background:var(--rdk-card);
  border:1px solid var(--rdk-line); border-radius:8px; padding:6px 10px; min-width:0} .rdk-card.rdk-missed {border-color:var(--rdk-red)}
.rdk-card .h {display:flex; justify-content:space-between; color:var(--rdk-quiet)} .rdk-card .h b {color:var(--rdk-tone)} .rdk-none .h b {visibility:hidden}
.rdk-card .v {font-size:22px; font-weight:600; font-variant-numeric:tabular-nums; white-space:nowrap; line-height:1.25} .rdk-card .v small {font-size:13px; font-weight:400}
.rdk-card .d {font-size:12px; color:var(--rdk-quiet); font-weight:400; margin-left:4px} .rdk-card .n {font-size:11.5px; color:var(--rdk-quiet); min-height:31px; display:block}
.rdk-gauge {display:block; position:relative; height:12px; background:var(--rdk-bar); border-radius:3px; margin:3px 0} .rdk-gauge i {position:absolute}
.rdk-gauge .s {top:3px; height:6px; background:var(--rdk-span); border-radius:3px} .rdk-gauge .p {top:1px; width:4px; height:10px; margin-left:-2px; background:var(--rdk-blue)}
.rdk-gauge .r {top:-2px; width:2px; height:16px; margin-left:-1px; background:var(--rdk-ink)} .rdk-old {opacity:.45}
.rdk-explorer table {border-collapse:collapse; font-size:12.5px; margin:4px 0} .rdk-explorer :is(th,td) {text-align:left; padding:1px 12px 1px 0; font-weight:400; background:none; border:0}
.rdk-explorer thead th {border-bottom:1px solid var(--rdk-edge); font-weight:600} .rdk-explorer td {font-variant-numeric:tabular-nums}
.rdk-scroll {overflow-x:auto} .rdk-waiting .rdk-svg {opacity:.4} .rdk-pictures {display:flex; gap:14px; justify-content:space-around; align-items:start}
.rdk-explorer .rdk-svg {height:auto; display:block; margin:auto} .rdk-pick {cursor:pointer} .rdk-controls {display:flex; flex-wrap:wrap; gap:4px 12px; align-items:center}
.rdk-controls label {display:flex; gap:5px; align-items:center} .rdk-wide {width:100%} .rdk-wide .rdk-row {max-width:340px; display:inline-grid; width:100%; margin-right:14px}
.rdk-pins {display:grid; grid-template-columns:auto repeat(3,1fr); gap:8px; align-items:stretch} .rdk-pin {border:1px solid var(--rdk-line); border-left:4px solid; border-radius:6px;
  padding:3px 8px; min-width:0; display:flex; justify-content:space-between; gap:4px} .rdk-explorer .rdk-pin button {background:none; border:0; padding:0 5px; min-height:24px; text-align:left}
.rdk-explorer .rdk-empty {border:1px dashed var(--rdk-edge); border-radius:6px; background:none; color:var(--rdk-quiet); text-align:left; padding:4px 8px; min-height:40px}
.rdk-drawer pre {white-space:pre-wrap; overflow-wrap:anywhere; max-height:300px; overflow:auto; background:var(--rdk-page); color:inherit; padding:8px; font-size:12px; margin:4px 0}
.rdk-explorer [role=alert] {border-left:4px solid var(--rdk-red); padding-left:8px} .rdk-gone {display:none; background:#b42318; color:#fff; padding:6px 16px}
.rdk-gone code {background:none; color:#fff; overflow-wrap:anywhere; user-select:all} .rdk-explorer.rdk-lost .rdk-gone, .jupyter-widgets-disconnected .rdk-gone {display:block}
@container (max-width:1020px) {.rdk-explorer .rdk-grid {grid-template-columns:278px minmax(0,1fr); grid-template-areas:"top top" "left verdict"
  "left views" "left picture" "side tray"} .rdk-cards {gap:4px} .rdk-card {padding:5px 6px; font-size:12px} .rdk-card .v {font-size:17px} .rdk-card .n, .rdk-card .d {display:none} .rdk-explorer .rdk-picture,.rdk-explorer .rdk-views {margin-right:12px !important}}
@container (max-width:700px) {.rdk-explorer .rdk-grid {display:flex; flex-direction:column; gap:8px} .rdk-explorer .rdk-verdict {position:sticky; top:0; z-index:4; margin:0 !important;
  background:var(--rdk-page); padding-bottom:4px !important} .rdk-explorer :is(.rdk-left,.rdk-views,.rdk-picture,.rdk-side,.rdk-tray) {margin:0 4px !important; padding:6px 8px}
  .rdk-explorer .rdk-verdict {order:-1} .rdk-explorer .rdk-top {order:-2} .rdk-bar .q {display:none} .rdk-explorer .rdk-views {margin-bottom:-8px !important}
  .rdk-cards {grid-template-columns:repeat(3,1fr); gap:4px; margin-top:4px} .rdk-card {padding:3px 6px} .rdk-card .n, .rdk-card .d, .rdk-card:nth-child(n+4) {display:none} .rdk-card .v {font-size:17px}
  .rdk-verdict .rdk-more, .rdk-say1 .l {display:none} .rdk-row {grid-template-columns:104px 1fr 62px 48px} .rdk-pins {grid-template-columns:1fr} .rdk-pictures {flex-direction:column}}
@media (forced-colors:active) {.rdk-explorer input[type=range]::-webkit-slider-runnable-track {background:CanvasText} .rdk-gauge {border:1px solid CanvasText}
  .rdk-gauge i, .rdk-slide i {background:Highlight; forced-color-adjust:none} .rdk-explorer [role=tab][aria-selected=true], .rdk-seg [aria-pressed=true] {outline:2px solid Highlight; outline-offset:-2px}}
"""
APP = """<style>body:has(.rdk-explorer) {margin:0; background:#f3f5f8} @media (prefers-color-scheme:dark) {body:has(.rdk-explorer) {background:#12161d}}
body:has(.rdk-explorer) :is(.jp-Notebook,.jp-Cell,.jp-OutputArea-child,.jp-OutputArea-output,#rendered_cells,.jp-Cell-outputWrapper,.jp-OutputArea) {padding:0 !important; margin:0 !important; max-width:none}
body:has(.rdk-explorer) .jp-OutputPrompt {display:none}</style>"""
"""Under Voila the explorer is the page."""

SCRIPT = """(root => {
if (root.dataset.alive) return; root.dataset.alive = 1;
const one = q => root.querySelector(q), all = q => [...root.querySelectorAll(q)], app = !!one('[data-app]');
let last = 0, acked = 0, queue = [], timer, seen = '', size = '', pressed = '', tab = '';
const send = (...event) => {
    queue = queue.filter(e => e[0] > acked && !(e[1] === event[0] && e[2] === event[1] && event[0] !== 'do'));
    last = Math.max(Date.now(), last + 1); queue.push([last, ...event]);
    const box = one('.rdk-bridge input'); box.value = JSON.stringify(queue);
    box.dispatchEvent(new Event('input', {bubbles: true})); box.dispatchEvent(new Event('change', {bubbles: true}));
    clearTimeout(timer); timer = setTimeout(() => root.classList.add('rdk-lost'), 8000);
};
const pages = () => all('[data-tab]').forEach(t => { const on = t.dataset.tab === (tab || 'rover');
    t.setAttribute('aria-selected', on); t.tabIndex = on ? 0 : -1; one(`[data-page=${t.dataset.tab}]`).hidden = !on; });
const apply = () => {
    const holder = one('.rdk-data [data-state]'); if (!holder || holder.dataset.state === seen) return;
    seen = holder.dataset.state; const d = JSON.parse(seen); acked = d.ack;
    root.classList.remove('rdk-lost'); if (acked >= last) clearTimeout(timer);
    if (acked >= last) {
        for (const [name, [at, words, tick, moved]] of Object.entries(d.v)) {
            const range = one(`[type=range][data-in=${name}]`), box = one(`.rdk-box[data-in=${name}]`);
            range.value = at; range.setAttribute('aria-valuetext', words + ' ' + range.dataset.unit); box.value = words;
            range.previousSibling.style.setProperty('--at', tick); one(`[data-do="reset:${name}"]`).style.visibility = moved ? '' : 'hidden';
        }
        for (const [name, value] of Object.entries(d.c)) {
            all(`select[data-in=${name}]`).forEach(s => s.value = value);
            all(`[data-name=${name}]`).forEach(b => b.setAttribute('aria-pressed', b.dataset.value === value));
        }
        all('[data-view]').forEach(t => { const on = t.dataset.view === d.c.view; t.setAttribute('aria-selected', on); t.tabIndex = on ? 0 : -1; });
        all('[data-for]').forEach(p => p.hidden = p.dataset.for !== d.c.view);
        all('button[data-do]').forEach(b => { if (b.dataset.do in d.off) b.disabled = d.off[b.dataset.do]; });
    }
    for (const [key, words] of Object.entries(d.t)) all(`[data-text=${key}]`).forEach(e => e.textContent = words);
    one('.rdk-picture').classList.toggle('rdk-waiting', d.busy || acked < last);
    const bar = one('progress'); bar.max = d.p[1]; bar.value = d.p[0]; bar.hidden = !d.p[2];
    if (app && d.link !== undefined) history.replaceState(null, '', location.pathname + (d.link ? '?' + d.link : ''));
};
const deliver = () => { const a = one('a[data-deliver]'); if (a) { a.removeAttribute('data-deliver'); a.click(); } };
const copy = text => (navigator.clipboard ? navigator.clipboard.writeText(text) : Promise.reject()).catch(() => {
    const box = document.createElement('textarea'); box.value = text; document.body.append(box); box.select(); document.execCommand('copy'); box.remove(); });
new MutationObserver(() => { apply(); deliver();
    if (pressed && document.activeElement === document.body) { const again = one(`[data-do="${pressed}"]`); if (again) again.focus(); }
}).observe(root, {subtree: true, childList: true});
root.addEventListener('input', e => { const i = e.target; if (i.type === 'range') send('slide', i.dataset.in, +i.value); });
root.addEventListener('change', e => { const i = e.target;
    if (i.type === 'file') { const file = i.files[0]; if (file) file.text().then(text => { send('do', 'load', file.name, text); i.value = ''; }); }
    else if (i.matches('.rdk-box')) send('type', i.dataset.in, i.value);
    else if (i.matches('select')) { send('choose', i.dataset.in, i.value); one('.rdk-picture').classList.add('rdk-waiting'); } });
root.addEventListener('click', e => { const b = e.target.closest('[data-do],[data-name],[data-view],[data-tab],[data-js]'); if (!b) return;
    const menu = b.closest('.rdk-bar details'); if (menu) menu.open = false;
    if (b.dataset.do) { pressed = b.dataset.do; send('do', b.dataset.do); }
    else if (b.dataset.name) send('choose', b.dataset.name, b.dataset.value);
    else if (b.dataset.view) { all('[data-view]').forEach(t => t.setAttribute('aria-selected', t === b));
        one('.rdk-picture').classList.add('rdk-waiting'); send('choose', 'view', b.dataset.view); }
    else if (b.dataset.tab) { tab = b.dataset.tab; pages(); }
    else if (b.dataset.js === 'open') one('[type=file]').click();
    else if (b.dataset.js === 'skip') { const v = one('.rdk-say1'); v.tabIndex = -1; v.focus(); }
    else if (b.dataset.js === 'copy') { const link = JSON.parse(seen).share, text = app ? location.origin + location.pathname + '?' + link : link;
        copy(text); send('do', 'copied'); } });
root.addEventListener('keydown', e => { const t = e.target;
    if (e.key === 'Escape') all('details[open]').forEach(d => { if (d.contains(t)) { d.open = false; d.querySelector('summary').focus(); } });
    if (t.matches('.rdk-box') && e.key === 'Enter') { e.preventDefault(); t.dispatchEvent(new Event('change', {bubbles: true})); }
    if (t.matches('.rdk-pick') && (e.key === 'Enter' || e.key === ' ')) { e.preventDefault(); pressed = t.dataset.do; send('do', t.dataset.do); }
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
    if (step && t.matches('[role=tab],.rdk-pick')) { e.preventDefault();
        const row = t.matches('.rdk-pick') ? all('.rdk-pick') : [...t.parentNode.children], next = row[(row.indexOf(t) + step + row.length) % row.length];
        next.tabIndex = 0; next.focus(); if (t.matches('[role=tab]')) next.click(); } });
root.addEventListener('toggle', e => { if (e.target.open && e.target.matches('.rdk-help')) all('.rdk-help[open]').forEach(d => d.open = d === e.target); }, true);
root.addEventListener('focusin', e => { e.target.dataset.lmSuppressShortcuts = 'true'; });
const measure = () => { const p = one('.rdk-picture'); if (!p || !p.clientWidth) return;
    const phone = root.clientWidth <= 700, room = app && !phone ? innerHeight - p.getBoundingClientRect().top - scrollY - (one('.rdk-tray')?.offsetHeight || 90) - 50 : 380;
    const now = [p.clientWidth - 24, Math.max(phone ? 320 : 300, Math.min(620, Math.round(room)))]; if (now.join() !== size) { size = now.join(); send('size', ...now); } };
let wait; new ResizeObserver(() => { clearTimeout(wait); wait = setTimeout(measure, 200); }).observe(root);
if (app) document.title = 'Rover explorer: will this rover do this mission?';
pages(); apply(); setTimeout(measure, 50); addEventListener('resize', measure);
})(this.closest('.rdk-explorer')); this.remove()"""


def _attribute(words):
    return html.escape(str(words), quote=True)


def styles(app):
    """The style, the script and, under Voila, what makes the explorer the page."""
    dark = 'body[data-jp-theme-light="false"] .rdk-explorer'
    rules = STYLE.replace("DARK", dark)
    if app:
        start = STYLE.index("DARK")
        rules += "@media (prefers-color-scheme:dark) {.rdk-explorer " + STYLE[start + 4:STYLE.index("}", start) + 1] + "}"
    return f"<style>{rules}</style>{APP * app}<img hidden alt='' src='data:,' onerror=\"{_attribute(SCRIPT)}\">"


def top(app):
    """The bar with the name and what acts on the whole."""
    saves = {"design.json": "Design (json)", "design.csv": "Design (csv)", "front.json": "Front (json)", "front.csv": "Front (csv)",
             "picture.svg": "Picture (svg)", "report.html": "Report (one page)"}
    menu = "".join(f'<button type="button" data-do="save:{name}">{words}</button>' for name, words in saves.items())
    return (f'{styles(app)}<header class="rdk-bar"{" data-app" * app}><h2>Rover explorer</h2>'
            '<button type="button" class="rdk-skip" data-js="skip">Skip to the answer</button>'
            '<span class="q">Will this rover do this mission?</span>'
            '<button type="button" data-do="undo">↶ Undo</button><button type="button" data-do="redo">↷ Redo</button>'
            '<button type="button" data-do="reset">Reset</button><button type="button" data-js="open">Open</button>'
            '<input type="file" accept=".json,.csv" hidden aria-label="open a file">'
            f'<details><summary>Save</summary><div>{menu}</div></details>'
            f'<button type="button" data-js="copy">Copy {"link" if app else "state"}</button>'
            '<button type="button" data-do="python">Python</button></header>'
            '<div class="rdk-gone" role="alert">No answer: the connection is lost. '
            + ("Reload the page; the address holds your rover and mission." if app else
               "Run the cell again. Your state, for <code>Explorer(state=\"...\")</code>: <code data-text=\"share\"></code>") + "</div>")


def row(name):
    """A slider with its label, help, number box, unit and the button back to the baseline."""
    f = NUMBERS[name]
    words = _attribute(f.label + (f" ({f.unit})" if f.unit else ""))
    return (f'<div class="rdk-row"><details class="rdk-help"><summary aria-label="about {f.label}">{f.label} <i>?</i></summary>'
            f'<p>{html.escape(f.help)}</p></details><span class="rdk-slide"><i></i><input type="range" data-in="{name}" min="0" '
            f'max="{f.positions}" data-unit="{f.unit}" aria-label="{f.label} slider"></span><input class="rdk-box" type="text" '
            f'inputmode="decimal" autocomplete="off" data-in="{name}" aria-label="{words}"><span class="u">{f.unit}</span>'
            f'<button type="button" class="rdk-back" data-do="reset:{name}" aria-label="reset {f.label}" title="reset">↺</button></div>')


def group(title, names):
    """Rows under a heading."""
    return f"<h3>{title}</h3>" + "".join(map(row, names))


def menu(name, words, options, cls="rdk-menu"):
    """A choice with its label."""
    items = "".join(f'<option value="{_attribute(value)}">{html.escape(str(text))}</option>' for value, text in options.items())
    label = "" if words else f' aria-label="{name}"'
    return f'<label class="{cls}"><span>{words}</span><select data-in="{name}"{label}>{items}</select></label>'


def segments(name, options, words):
    """A choice among two, as buttons."""
    items = "".join(f'<button type="button" data-name="{name}" data-value="{value}">{text}</button>' for value, text in options.items())
    return f'<div class="rdk-seg" role="group" aria-label="{words}">{items}</div>'


def left(menus):
    """The inputs: one page for the rover, one for the mission."""
    names = list(DESIGN)
    site = [n for n in ("latitude_deg", "duration_earth_days", "slope_deg", "traverse_limit_km") if n in MISSION]
    work = ["duty_cycle", "payload_mass_kg", "payload_power_w", "required_obstacle_height_m"]
    rest = [n for n in MISSION if n not in site + work]
    more = '<details class="rdk-more"><summary>more: {}</summary>{}</details>'
    rover = (menu("rover", "", menus["rover"], "rdk-menu rdk-sole") + group("Wheels", names[:4]) + segments("wheel_count", menus["wheel_count"], "wheels")
             + group("Body", names[4:6]) + group("Power", names[6:])
             + more.format("coefficients of the model", menu("preset", "Model", menus["preset"]) + "".join(map(row, COEFFICIENTS))))
    mission = (menu("mission", "", menus["mission"], "rdk-menu rdk-sole") + '<p class="rdk-say" data-text="summary"></p>' + group("Site", site)
               + menu("soil", "soil", menus["soil"]) + group("Work", work) + group("Demands", list(DEMANDS)[:-1])
               + segments("survive", menus["survive"], "survival of heat and cold")
               + more.format("array" + ", speed limit" * ("maximum_speed_m_s" in rest), "".join(map(row, rest)))
               + more.format("numbers of the soil", "".join(map(row, SOIL))))
    return ('<nav role="tablist" aria-label="inputs"><button type="button" role="tab" data-tab="rover">Rover</button>'
            '<button type="button" role="tab" data-tab="mission"><span data-text="mission"></span></button></nav>'
            f'<section data-page="rover" aria-label="rover">{rover}</section>'
            f'<section data-page="mission" aria-label="mission" hidden>{mission}</section>')


def views(menus):
    """The tabs of the pictures, and what some of them can be asked."""
    tabs = "".join(f'<button type="button" role="tab" data-view="{name}">{words}</button>' for name, words in VIEWS.items())
    small = "rdk-small"
    search = ('<button type="button" class="rdk-btn rdk-main" data-do="run">Run search</button>'
              '<button type="button" class="rdk-btn" data-do="cancel">Cancel</button>' + segments("live", {"False": "once", "True": "live"}, "search")
              + '<button type="button" class="rdk-btn" data-do="lightest" title="with the demands of the mission page">Lightest rover for the demands</button>'
              + menu("solve_variable", "or solve", menus["solve_variable"], small) + '<button type="button" class="rdk-btn" data-do="solve">for the demands</button>')
    axes = "".join(menu(f"front_{key}", words, menus[f"front_{key}"], small) for key, words in (("x", "across"), ("y", "up"), ("colour", "colour")))
    goals = "".join(menu(name, words, menus[name], small) for name, words in (("range_goal", "range"), ("mass_goal", "mass"), ("slope_goal", "slope")))
    panels = {"why": menu("why_metric", "metric", menus["why_metric"], small) + menu("baseline", "against", menus["baseline"], small),
              "sweep": menu("sweep_metric", "metric", menus["sweep_metric"], small) + menu("sweep_first", "along", menus["sweep_first"], small)
              + menu("sweep_second", "and", menus["sweep_second"], small),
              "optimise": search + axes + '<details class="rdk-more rdk-wide"><summary>advanced: goals and size of the search</summary>'
              f'<div class="rdk-controls">{goals}</div>' + "".join(map(row, SEARCH)) + "</details>"
              '<progress max="1" value="0" hidden aria-label="search"></progress><span class="rdk-say" role="status" data-text="status"></span>'}
    return (f'<nav role="tablist" aria-label="pictures">{tabs}</nav>'
            + "".join(f'<div class="rdk-controls" data-for="{name}" hidden>{panel}</div>' for name, panel in panels.items()))


STATUS = {"met": "✓ met", "missed": "✗ missed", "risk": "! at risk", "none": ""}


def verdict(status, sentence, why, levers, odds):
    """The answer in words; levers are (action, words)."""
    icon = {"met": "✓", "missed": "✗", "risk": "!"}[status]
    buttons = "".join(f'<button type="button" data-do="{action}">{html.escape(words)}</button>' for action, words in levers)
    return (f'<section class="rdk-say1 rdk-{status}" aria-label="answer"><div role="status"><b>{icon} {html.escape(sentence)}</b> '
            f'<span class="rdk-say">{html.escape(odds)}</span></div><div class="l">{html.escape(why)} {buttons}</div></section>')


def card(title, value, unit, status, note, change="", at=None, interval=None, need=None, old=False):
    """A reading: value, 90 % interval, requirement, status and change since the last move."""
    gauge = ""
    known = [v for v in (at, need, *(interval or ())) if v is not None and v == v and abs(v) != float("inf")]
    if at is not None and known:
        low, high = min(known), max(known)
        low, wide = low - 0.06 * (high - low or abs(high) or 1), 1.12 * (high - low or abs(high) or 1)

        def share(v):
            return f"{min(max(100 * (v - low) / wide, 0), 100):.1f}%"

        gauge = "" if interval is None else f'<i class="s" style="left:{share(interval[0])};right:calc(100% - {share(interval[1])})"></i>'
        gauge += f'<i class="p" style="left:{share(at)}"></i>' + (f'<i class="r" style="left:{share(need)}"></i>' if need is not None else "")
    return (f'<div class="rdk-card rdk-{status}"><span class="h"><span>{title}</span><b>{STATUS[status]}</b></span><span class="v">{value} '
            f'<small>{unit}</small><span class="d">{change}</span></span><span class="rdk-gauge{" rdk-old" * old}" aria-hidden="true">{gauge}</span>'
            f'<span class="n{" rdk-old" * old}">{html.escape(note)}</span></div>')


def table(header, rows):
    """A table; the first cell of a row names it."""
    head = "".join(f'<th scope="col">{html.escape(cell)}</th>' for cell in header)
    body = "".join(f'<tr><th scope="row">{html.escape(first)}</th>' + "".join(f"<td>{html.escape(cell)}</td>" for cell in rest) + "</tr>"
                   for first, *rest in rows)
    return f'<div class="rdk-scroll" tabindex="0"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def details(header, rows):
    """All readings, folded away."""
    return f'<details class="rdk-more"><summary>all readings</summary>{table(header, rows)}</details>'


def tray(pins, colours):
    """The pinned designs; each is (letter, title, words)."""
    cards = "".join(
        f'<div class="rdk-pin" style="border-left-color:{colour}"><button type="button" data-do="use:{i}" title="back to this design">'
        f'<b>{letter} {html.escape(title)}</b><br>{html.escape(words)}</button><button type="button" data-do="unpin:{i}" aria-label="remove {letter}">✕</button></div>'
        for i, ((letter, title, words), colour) in enumerate(zip(pins, colours)))
    empty = '<button type="button" class="rdk-empty" data-do="pin">+ pin the present design</button>' if len(pins) < 3 else ""
    differ = '<button type="button" class="rdk-btn" data-do="differences">Table of differences</button>' if pins else '<span class="rdk-say">pinned designs</span>'
    return f'<section class="rdk-pins" aria-label="compare"><div><b>Compare</b><br>{differ}</div>{cards}{empty}</section>'


def drawer(title, body):
    """Something to read, with a button that puts it away; empty for nothing."""
    if not body:
        return ""
    return (f'<section aria-label="{_attribute(title)}"><div class="rdk-controls"><b>{html.escape(title)}</b>'
            f'<button type="button" class="rdk-btn" data-do="close">Close</button></div>{body}</section>')
