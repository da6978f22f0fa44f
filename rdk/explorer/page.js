(root => {
if (root.dataset.alive) return; root.dataset.alive = 1;
const one = q => root.querySelector(q), all = q => [...root.querySelectorAll(q)], app = !!one('[data-app]');
let last = 0, acked = 0, queue = [], tab = 'rover', timer, seen, size, pressed, link, naming, unfolded;
const send = (...event) => {
    queue = queue.filter(e => e[0] > acked); const before = queue.at(-1);        /* only a drag's way is forgotten */
    if (before && event[0] === 'slide' && before[1] === 'slide' && before[2] === event[1]) queue.pop();
    last = Math.max(Date.now(), last + 1); queue.push([last, ...event]);
    one('.rdk-picture').classList.add('rdk-waiting');
    const box = one('.rdk-bridge input'); box.value = JSON.stringify(queue);
    box.dispatchEvent(new Event('input', {bubbles: true})); box.dispatchEvent(new Event('change', {bubbles: true}));
    clearTimeout(timer); timer = setTimeout(() => root.classList.add('rdk-lost'), 8000);
};
const choose = (kind, name) => all(`[data-${kind}]`).forEach(t => { const on = t.dataset[kind] === name;
    t.setAttribute('aria-selected', on); t.tabIndex = on ? 0 : -1; });
const pages = () => { choose('tab', tab); all('[data-page]').forEach(p => p.hidden = p.dataset.page !== tab); };
const put = (box, words) => { if (!box.dataset.typing) box.value = words; };          /* what is being typed stays */
const apply = () => {
    const holder = one('.rdk-data [data-state]'); if (!holder || holder.dataset.state === seen) return;
    seen = holder.dataset.state; const d = JSON.parse(seen); acked = d.ack;
    root.classList.remove('rdk-lost'); if (acked >= last) clearTimeout(timer);
    if (acked >= last) {
        for (const [name, [at, words, tick, moved]] of Object.entries(d.v)) {
            const range = one(`[type=range][data-in=${name}]`), box = one(`.rdk-box[data-in=${name}]`);
            range.value = at; range.setAttribute('aria-valuetext', words + ' ' + range.dataset.unit); put(box, words);
            range.previousSibling.style.setProperty('--at', tick);
            one(`[data-do="reset:${name}"]`).style.visibility = moved ? '' : 'hidden';
        }
        for (const [name, value] of Object.entries(d.c)) {
            all(`:is(select, .rdk-box)[data-in=${name}]`).forEach(s => put(s, value));
            all(`[data-name=${name}]`).forEach(b => b.setAttribute('aria-pressed', b.dataset.value === value));
        }
        choose('view', d.c.view);
        all('[data-for]').forEach(p => p.hidden = p.dataset.for !== d.c.view);
        all('button[data-do]').forEach(b => { if (b.dataset.do in d.off) b.disabled = d.off[b.dataset.do]; });
    }
    for (const [key, words] of Object.entries(d.t)) all(`[data-text=${key}]`).forEach(e => e.textContent = words);
    one('.rdk-picture').classList.toggle('rdk-waiting', d.busy || acked < last);
    setTimeout(measure, 60);                             /* the room for the picture may have changed */
    const bar = one('progress'); bar.max = d.p[1]; bar.value = d.p[0]; bar.hidden = !d.p[2];
    if (app) { link = d.t.share; naming ||= setTimeout(name, 100); }       /* browsers ignore calls that come faster */
};
const name = () => { naming = 0; history.replaceState(null, '', location.pathname + (link ? '?' + link : '')); };
const deliver = () => { const a = one('a[data-deliver]'); if (a) { a.removeAttribute('data-deliver'); a.click(); } };
const copy = text => (navigator.clipboard ? navigator.clipboard.writeText(text) : Promise.reject()).catch(() => {
    const box = document.createElement('textarea'); box.value = text; document.body.append(box); box.select();
    document.execCommand('copy'); box.remove(); });
new MutationObserver(() => { apply(); deliver();
    const readings = one('.rdk-verdict details'); if (readings && unfolded) readings.open = true;
    if (pressed && document.activeElement === document.body) { const again = one(`[data-do="${pressed}"]`);
        if (again) again.focus(); }
}).observe(root, {subtree: true, childList: true});
root.addEventListener('input', e => { const i = e.target; if (i.type === 'range') send('slide', i.dataset.in,
    +i.value); else if (i.matches('.rdk-box')) i.dataset.typing = 1; });
root.addEventListener('focusout', e => { delete e.target.dataset.typing; });
root.addEventListener('change', e => { const i = e.target; delete i.dataset.typing;
    if (i.type === 'file') { const file = i.files[0]; if (file) file.text().then(text => {
        send('do', 'load', file.name, text); i.value = ''; }); }
    else if (i.matches('.rdk-box, select')) send('set', i.dataset.in, i.value); });
root.addEventListener('click', e => {
    all(':is(.rdk-help, .rdk-bar details, .rdk-controls .rdk-more)[open]').forEach(d => {
        if (!d.contains(e.target) || e.target.closest('.rdk-bar button')) d.open = false; });
    const b = e.target.closest('[data-do],[data-name],[data-view],[data-tab],[data-js]'); if (!b) return;
    if (b.dataset.do) { pressed = b.dataset.do; send('do', b.dataset.do); }
    else if (b.dataset.name) send('set', b.dataset.name, b.dataset.value);
    else if (b.dataset.view) { choose('view', b.dataset.view); send('set', 'view', b.dataset.view); }
    else if (b.dataset.tab) { tab = b.dataset.tab; pages(); }
    else if (b.dataset.js === 'open') one('[type=file]').click();
    else if (b.dataset.js === 'skip') { const v = one('.rdk-say1'); v.tabIndex = -1; v.focus(); }
    else if (b.dataset.js === 'copy') { const state = JSON.parse(seen).t.share;
        copy(app ? location.origin + location.pathname + '?' + state : state); send('do', 'copied'); } });
root.addEventListener('keydown', e => { const t = e.target;
    if (e.key === 'Escape') all('details[open]').forEach(d => { if (d.contains(t)) { d.open = false;
        d.querySelector('summary').focus(); } });
    if (t.matches('.rdk-box') && e.key === 'Enter') { e.preventDefault();
        t.dispatchEvent(new Event('change', {bubbles: true})); }
    if (t.matches('.rdk-pick') && (e.key === 'Enter' || e.key === ' ')) { e.preventDefault();
        t.dispatchEvent(new Event('click', {bubbles: true})); }
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
    if (step && t.matches('[role=tab],.rdk-pick')) { e.preventDefault();
        const row = t.matches('.rdk-pick') ? all('.rdk-pick') : [...t.parentNode.children];
        const next = row[(row.indexOf(t) + step + row.length) % row.length];
        next.tabIndex = 0; next.focus(); if (t.matches('[role=tab]')) next.click(); } });
root.addEventListener('toggle', e => { if (e.target.matches('.rdk-verdict details')) unfolded = e.target.open;
    else if (e.target.open) e.target.scrollIntoView({block: 'nearest'}); }, true);
root.addEventListener('focusin', e => { e.target.dataset.lmSuppressShortcuts = 'true';
    if (e.target.dataset.do !== pressed) pressed = ''; });
const measure = () => { const p = one('.rdk-picture'); if (!p || !p.clientWidth) return;
    const now = [p.clientWidth - 24, app && root.clientWidth > 1120 ? p.clientHeight - 12 : 380];
    if (now.join() !== size) { size = now.join(); send('size', ...now); } };
let wait; new ResizeObserver(() => { clearTimeout(wait); wait = setTimeout(measure, 200); }).observe(root);
if (app) document.title = 'Rover explorer: will this rover do this mission?';
pages(); apply(); setTimeout(measure, 50); addEventListener('resize', measure);
})(this.closest('.rdk-explorer')); this.remove()
