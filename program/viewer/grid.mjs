// A texture to judge UVs by, where the user has none: cells with names, in colours that turn with u and lighten with v.

const CELLS = 8, PIXELS = 1024;

export function testGrid() {
  const canvas = document.createElement('canvas'), cell = PIXELS / CELLS;
  canvas.width = canvas.height = PIXELS;
  const pen = canvas.getContext('2d');
  pen.textAlign = 'center';
  pen.textBaseline = 'middle';
  for (let row = 0; row < CELLS; ++row) {
    for (let column = 0; column < CELLS; ++column) {
      const x = column * cell, y = (CELLS - 1 - row) * cell, light = 42 + 5 * row + ((row + column) % 2 ? 6 : 0);
      pen.fillStyle = `hsl(${360 * column / CELLS} 48% ${light}%)`;
      pen.fillRect(x, y, cell, cell);
      pen.strokeStyle = 'rgb(255 255 255 / 0.75)';
      pen.lineWidth = 3;
      pen.strokeRect(x + 1.5, y + 1.5, cell - 3, cell - 3);
      pen.fillStyle = light > 60 ? 'rgb(20 24 32 / 0.85)' : 'rgb(255 255 255 / 0.95)';
      pen.font = `600 ${0.36 * cell}px system-ui, sans-serif`;
      pen.fillText(`${'ABCDEFGH'[column]}${row + 1}`, x + cell / 2, y + cell / 2);
    }
  }
  return canvas;
}
