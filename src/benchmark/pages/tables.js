// Tables whose cells are text, and links where there is something to look at.

const byId = (id) => document.getElementById(id);
const page = JSON.parse(byId('data').textContent);
const whole = (value) => value === null || value === undefined ? '-' : value.toLocaleString('en');
const percent = (share) => (100 * share).toFixed(1) + ' %';
const known = (value) => value !== null && value !== undefined;

// A cell's content: a text, or {text, link, kind (CSS class), span, title, node}.
function fillCell(cell, content) {
  const given = content !== null && typeof content === 'object' ? content : { text: content };
  if (given.kind) cell.className = given.kind;
  if (given.span) cell.colSpan = given.span;
  if (given.title) cell.title = given.title;
  if (given.node) { cell.append(given.node); return; }
  if (given.link) {
    const link = document.createElement('a');
    link.href = given.link;
    link.textContent = given.text;
    cell.append(link);
  } else {
    cell.textContent = given.text;
  }
}

// head: texts, or [text, small text below it].
function drawTable(table, head, rows) {
  const row = table.createTHead().insertRow();
  for (const text of head) {
    const cell = document.createElement('th');
    cell.scope = 'col';
    const [main, small] = Array.isArray(text) ? text : [text, ''];
    cell.textContent = main;
    if (small) { const below = document.createElement('small'); below.textContent = small; cell.append(below); }
    row.append(cell);
  }
  const body = table.createTBody();
  for (const cells of rows) {
    const line = body.insertRow();
    for (const content of cells) fillCell(line.insertCell(), content);
  }
}

function drawTiles(host, tiles) {
  host.replaceChildren(...tiles.map(([value, label, kind]) => {
    const tile = document.createElement('div');
    tile.className = 'tile ' + (kind || '');
    const figure = document.createElement('b');
    figure.textContent = value;
    const text = document.createElement('span');
    text.textContent = label;
    tile.append(figure, text);
    return tile;
  }));
}
