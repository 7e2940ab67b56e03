// SPDX-License-Identifier: BSD-3-Clause
// The viewer of mreport's page: unpacks the meshes of the page and draws them with WebGL 2, without any library.
// Where there is no WebGL, the pictures that the page holds stay in sight.
'use strict';
(() => {
const $ = id => document.getElementById(id);
const report = JSON.parse($('data').textContent);
// name, result (its number), kind (result, reference, plane meshes, charts), counts, box, columns, labels
const meshes = report.meshes, flat = mesh => mesh.kind === 'charts' || mesh.kind === 'plane meshes';
// charts have the triangles of the mesh that they map
const base = mesh => mesh.kind === 'charts' ? meshes.find(m => m.result === mesh.result && m.kind === 'result') : mesh;
const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
const say = text => { $('status').textContent = text; };
const short = x => Number(x.toPrecision(4)).toString();

// ---- meshes: deflated, in base64 (tools/report/pack.cc writes them)

function inflated(id) {
  const text = atob($(id).textContent), packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate')));
}
async function unpack(mesh) {
  const bytes = new Uint8Array(await inflated(mesh.id).arrayBuffer());
  const n = mesh.vertices + mesh.dots, m = mesh.triangles;
  let at = 0;
  const points = [0, 1, 2].map(() => {
    const axis = new Uint16Array(n);
    for (let i = 0, last = 0; i < n; ++i) {
      const code = bytes[at + i] | bytes[at + n + i] << 8;
      axis[i] = last = (last + (code >> 1 ^ -(code & 1))) & 0xffff;
    }
    at += 2 * n;
    return axis;
  });
  const corners = new Uint32Array(3 * m);
  for (let i = 0, next = 0; i < 3 * m; ++i) {
    let code = 0, shift = 0, byte;
    do { byte = bytes[at++]; code |= (byte & 127) << shift; shift += 7; } while (byte & 128);
    corners[i] = next - code;
    if (code === 0) ++next;
  }
  mesh.points = points;
  mesh.corners = corners;
  const take = () => bytes.subarray(at, at += m);
  mesh.thick = take();
  mesh.spacing = take();
  mesh.value = {};
  const measures = measured(mesh);
  for (const c of mesh.columns) mesh.value[c.name] = corrected(c, measures, take());
  mesh.label = {};
  for (const l of mesh.labels) {
    const low = take(), high = take();
    mesh.label[l.name] = Uint16Array.from(low, (x, i) => x | high[i] << 8);
  }
  if (base(mesh) === mesh) return;
  if (!base(mesh).corners) await unpack(base(mesh));
  for (const key of ['thick', 'spacing', 'columns', 'labels', 'value', 'label']) mesh[key] = base(mesh)[key];
}
// figures that follow from the positions, from the sides of a triangle and twice its area; bytes correct them
const figures = {
  kappa: (a, b, c, area) => 4 * area * area / (a * b * c * (a + b + c)),
  'smallest angle': (a, b, c, area) => Math.asin(Math.min(1, area * Math.min(a, b, c) / (a * b * c))) * 180 / Math.PI,
  size: (a, b, c) => (a + b + c) / 3,
};
function measured(mesh) {  // three sides and twice the area of each triangle
  const m = mesh.triangles, all = new Float64Array(4 * m), axes = mesh.points.map((p, k) => Float64Array.from(p, x => mesh.low[k] + x * mesh.step[k]));
  const d = new Float64Array(9);
  for (let t = 0; t < m; ++t) {
    for (let i = 0; i < 3; ++i) {
      const v = mesh.corners[3 * t + i], w = mesh.corners[3 * t + (i + 1) % 3];
      for (let k = 0; k < 3; ++k) d[3 * i + k] = axes[k][w] - axes[k][v];
      all[4 * t + i] = Math.sqrt(d[3 * i] ** 2 + d[3 * i + 1] ** 2 + d[3 * i + 2] ** 2);
    }
    all[4 * t + 3] = Math.sqrt((d[1] * d[5] - d[2] * d[4]) ** 2 + (d[2] * d[3] - d[0] * d[5]) ** 2 + (d[0] * d[4] - d[1] * d[3]) ** 2);
  }
  return all;
}
function corrected(c, measures, bytes) {
  const figure = figures[c.name], f = c.log ? Math.log : x => x, low = f(c.low), scale = f(c.high) - low;
  if (!figure) return bytes;
  return bytes.map((byte, t) => {
    const i = 4 * t, x = figure(measures[i], measures[i + 1], measures[i + 2], measures[i + 3]);
    const share = scale > 0 ? (f(x) - low) / scale : 0;
    return byte + (share > 0 ? Math.round(255 * Math.min(share, 1)) : 0);
  });
}

const place = (mesh, v) => [0, 1, 2].map(k => mesh.low[k] + mesh.points[k][v] * mesh.step[k]);
const corner = (mesh, t) => [0, 1, 2].map(i => place(mesh, mesh.corners[3 * t + i]));
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
function middle(mesh, t) {
  const p = corner(mesh, t), c = [0, 1, 2].map(k => (p[0][k] + p[1][k] + p[2][k]) / 3);
  return {center: c, reach: Math.max(...p.map(q => Math.hypot(...sub(q, c))))};
}
const column = (mesh, name) => mesh.columns.find(c => c.name === name);
function value(c, byte) {
  const x = byte / 255;
  return c.log ? c.low * (c.high / c.low) ** x : c.low + (c.high - c.low) * x;
}

// ---- colors

const stops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];  // viridis
function ramp(x) {
  const y = Math.min(Math.max(x, 0), 1) * 4, i = Math.min(Math.floor(y), 3), f = y - i;
  return stops[i].map((a, k) => Math.round(a + f * (stops[i + 1][k] - a)));
}
const names = {};  // of labels, in the order they are met: the same color wherever a name is the same
function hue(kind, name) {
  const all = names[kind] ||= [];
  let i = all.indexOf(name);
  if (i < 0) i = all.push(name) - 1;
  const h = (0.58 + i * 0.381966) % 1 * 6;
  return [0, 4, 2].map(s => Math.round(120 + 125 * Math.min(Math.max(Math.abs((h + s) % 6 - 3) - 1, 0), 1)));
}
const plain = [214, 205, 188], fault = [226, 41, 41];
let colorBy = 'kappa';
function range(name) {  // of all meshes in sight, so that equal colors are equal values
  const found = panes.map(p => p.mesh && column(p.mesh, name)).filter(Boolean);
  return {low: Math.min(...found.map(c => c.low)), high: Math.max(...found.map(c => c.high)), log: found[0]?.log};
}
function colors(mesh) {  // four bytes for each corner
  const m = mesh.triangles, rgba = new Uint8Array(12 * m + 4 * mesh.dots), c = column(mesh, colorBy), labels = mesh.labels.find(l => l.name === colorBy);
  let table = null, index = null;
  if (c) {
    const all = range(colorBy), f = all.log ? Math.log : x => x;
    table = Array.from({length: 256}, (_, i) => ramp((f(value(c, i)) - f(all.low)) / (f(all.high) - f(all.low) || 1)));
    index = mesh.value[colorBy];
  } else if (labels) {
    table = labels.names.map(n => hue(colorBy, n));
    index = mesh.label[colorBy];
  }
  for (let t = 0; t < m; ++t) {
    const rgb = table ? table[index[t]] || plain : plain;
    for (let i = 12 * t; i < 12 * t + 12; i += 4) rgba[i] = rgb[0], rgba[i + 1] = rgb[1], rgba[i + 2] = rgb[2];
  }
  const paint = (t, rgb, mark) => {
    for (let i = 12 * t; i < 12 * t + 12; i += 4) {
      if (rgb) rgba[i] = rgb[0], rgba[i + 1] = rgb[1], rgba[i + 2] = rgb[2];
      rgba[i + 3] = mark;
    }
  };
  if (mesh.kind === 'result') for (const t of report.results[mesh.result].offending) paint(t, fault, 0);
  if (chosen && same(mesh) && chosen.triangle < m) paint(chosen.triangle, null, 255);
  return rgba;
}
function legend() {
  const box = $('legend'), all = range(colorBy);
  box.textContent = '';
  const add = (style, text) => {
    const item = document.createElement('span'), swatch = document.createElement('i');
    swatch.style.background = style;
    item.append(swatch, text);
    box.append(item);
    return swatch;
  };
  if (all.log !== undefined) {
    add(`linear-gradient(to right, ${stops.map(s => `rgb(${s})`)})`, `${colorBy}: ${short(all.low)} (dark) to ${short(all.high)} (light)` + (all.log ? ', logarithmic' : '')).className = 'scale';
  } else {
    const shown = (names[colorBy] || []).slice(0, 24);
    for (const n of shown) add(`rgb(${hue(colorBy, n)})`, n);
    if ((names[colorBy] || []).length > 24) box.append(`and ${names[colorBy].length - 24} more`);
  }
  if (panes.some(p => p.mesh?.kind === 'result' && report.results[p.mesh.result].offending.length)) add(`rgb(${fault})`, 'offending');
  if (panes.some(p => p.mesh?.dots)) add('rgb(255 170 0)', 'points of lines');
}

// ---- drawing

const vertexShader = `#version 300 es
in vec4 position; in vec4 color;
uniform mat4 view; uniform float dots;
out vec3 shade; out vec3 bary; out vec3 eye; flat out int thick; flat out float spacing; out float mark;
void main() {
  int w = int(position.w + 0.5), i = w & 3;
  bary = vec3(i == 0, i == 1, i == 2);
  thick = w >> 2 & 7;
  spacing = exp2((float(w >> 5) - 255.0) / 16.0);  // of thick edges, over the diagonal
  shade = color.rgb; mark = color.a;
  gl_Position = view * vec4(position.xyz, 1);
  eye = gl_Position.xyz;
  gl_PointSize = dots;
  if (dots > 0.0) gl_Position.z -= 0.002;  // in front of the surface that they lie on
}`;
const fragmentShader = `#version 300 es
precision highp float;
in vec3 shade; in vec3 bary; in vec3 eye; flat in int thick; flat in float spacing; in float mark;
uniform vec3 stretch; uniform float front, dots, pixels; uniform bool wire; uniform bool flatView;
out vec4 pixel;
void main() {
  vec3 p = eye * stretch;
  if (-p.z > front) discard;
  if (dots > 0.0) {
    float r = 2.0 * length(gl_PointCoord - 0.5);
    if (r > 1.0) discard;
    pixel = vec4(r > 0.7 ? vec3(0) : vec3(1, 0.67, 0), 1);
    return;
  }
  vec3 n = normalize(cross(dFdx(p), dFdy(p)));
  vec3 c = gl_FrontFacing ? shade : mix(shade, vec3(0.45), 0.75) * 0.7;
  c *= flatView ? 1.0 : 0.45 + 0.55 * abs(n.z);
  vec3 width = fwidth(bary), d = bary / width;  // pixels to each edge; component i: the edge across corner i
  float height = 1.0 / max(width.x, max(width.y, width.z));  // of the triangle, in pixels
  if (wire) {
    float line = 1.0 - smoothstep(0.2, 1.2, min(d.x, min(d.y, d.z)));
    c = mix(c, vec3(0.05), 0.75 * line * clamp((height - 2.0) / 6.0, 0.0, 1.0));
  }
  float strong = 1e3;  // distance to thick edges; bit i: from corner i to the next
  if ((thick & 1) != 0) strong = min(strong, d.z);
  if ((thick & 2) != 0) strong = min(strong, d.x);
  if ((thick & 4) != 0) strong = min(strong, d.y);
  float share = clamp(spacing * pixels * (flatView ? 1.0 : abs(n.z)) / 16.0, 0.0, 1.0);  // where they are dense, thinner and fainter
  c = mix(c, vec3(0), min(1.0, 2.0 * share) * (1.0 - smoothstep(0.0, 1.0, strong - 1.5 * share + 0.5)));
  if (mark > 0.5) c = mix(mix(c, vec3(0.82, 0, 0.56), 0.25), vec3(0.82, 0, 0.56), 1.0 - smoothstep(2.0, 3.5, min(d.x, min(d.y, d.z))));
  pixel = vec4(c, 1);
}`;

// rows of a view: right, up, towards the viewer
function axes(cam) {
  const a = cam.azimuth * Math.PI / 180, e = cam.elevation * Math.PI / 180;
  const ca = Math.cos(a), sa = Math.sin(a), ce = Math.cos(e), se = Math.sin(e);
  return [[-sa, ca, 0], [-ca * se, -sa * se, ce], [ca * ce, sa * ce, se]];
}

class Pane {
  constructor(root) {
    this.root = root;
    this.select = root.querySelector('select');
    this.canvas = root.querySelector('canvas');
    this.mark = root.querySelector('.mark');
    this.still = root.querySelector('.still');
    const gl = this.gl = this.canvas.getContext('webgl2', {antialias: true, preserveDrawingBuffer: true});
    if (!gl) throw new Error('no WebGL');
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'position');
    gl.bindAttribLocation(program, 1, 'color');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || 'no shader');
    gl.useProgram(program);
    this.at = Object.fromEntries(['view', 'stretch', 'front', 'wire', 'flatView', 'dots', 'pixels'].map(n => [n, gl.getUniformLocation(program, n)]));
    this.buffers = [gl.createBuffer(), gl.createBuffer()];
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);
    this.own = null;  // camera of charts
    this.listen();
  }
  get camera() { return this.own || camera; }
  async show(mesh) {
    this.root.hidden = !mesh && this !== panes[0];
    this.canvas.parentElement.hidden = !mesh;
    this.mesh = null;
    if (!mesh) return;
    if (!mesh.corners) await unpack(mesh);
    this.mesh = mesh;
    this.own = flat(mesh) ? {...whole(mesh), azimuth: -90, elevation: 90} : null;
    this.canvas.setAttribute('aria-label', `${mesh.name}: ${mesh.triangles} triangles`);
    const m = mesh.triangles, data = new Uint16Array(12 * m + 4 * mesh.dots), [x, y, z] = mesh.points;
    for (let h = 0; h < 3 * m + mesh.dots; ++h) {
      const v = h < 3 * m ? mesh.corners[h] : mesh.vertices + h - 3 * m, t = Math.floor(h / 3);
      data[4 * h] = x[v];
      data[4 * h + 1] = y[v];
      data[4 * h + 2] = z[v];
      data[4 * h + 3] = h % 3 | mesh.thick[t] << 2 | mesh.spacing[t] << 5;
    }
    const gaps = Array.from({length: mesh.dots}, (_, i) => Math.hypot(...sub(place(mesh, mesh.vertices + i), place(mesh, mesh.vertices + Math.max(0, i - 1)))));
    this.apart = gaps.sort((a, b) => a - b)[mesh.dots >> 1] || 0;  // points of lines, as a rule
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[0]);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 4, gl.UNSIGNED_SHORT, false, 0, 0);
  }
  recolor() {
    if (!this.mesh) return;
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[1]);
    gl.bufferData(gl.ARRAY_BUFFER, colors(this.mesh), gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
  }
  axes() { return axes(this.camera); }
  // half the height of what is in view: more where the canvas is narrower than fit expects
  get half() { return this.camera.half * Math.max(1, least_aspect * this.canvas.clientHeight / this.canvas.clientWidth); }
  // how far in front of its center the view begins: close to a triangle flown to, what would hide it is cut away
  get front() {
    const near = 1 - 2 * this.camera.half / whole(this.mesh).half;
    return chosen?.flown && !this.own && near > 0 ? this.camera.half / (4 * near) : 1e30;
  }
  draw() {
    if (!this.mesh) return;
    const gl = this.gl, c = this.canvas, mesh = this.mesh, cam = this.camera;
    const ratio = Math.min(devicePixelRatio || 1, 2), w = Math.round(c.clientWidth * ratio), h = Math.round(c.clientHeight * ratio);
    if (!w || !h) return;
    if (c.width !== w || c.height !== h) c.width = w, c.height = h;
    const axes = this.axes(), s = this.half, depth = 2 * mesh.diagonal || 1, scale = [h / (w * s), 1 / s, -1 / depth], m = new Float32Array(16);
    const from = sub(mesh.low, cam.center);
    for (let r = 0; r < 3; ++r) {
      for (let k = 0; k < 3; ++k) m[4 * k + r] = scale[r] * axes[r][k] * mesh.step[k];
      m[12 + r] = scale[r] * dot(axes[r], from);
    }
    m[15] = 1;
    gl.viewport(0, 0, w, h);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.at.view, false, m);
    gl.uniform3f(this.at.stretch, s * w / h, s, depth);
    gl.uniform1f(this.at.front, this.front);
    gl.uniform1i(this.at.wire, $('wire').checked ? 1 : 0);
    gl.uniform1i(this.at.flatView, this.own ? 1 : 0);
    gl.uniform1f(this.at.pixels, base(mesh).diagonal * h / (2 * s));
    gl.uniform1f(this.at.dots, 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3 * mesh.triangles);
    gl.uniform1f(this.at.dots, Math.min(Math.max(0.2 * this.apart * h / s, 2 * ratio), 7 * ratio));
    if (mesh.dots) gl.drawArrays(gl.POINTS, 3 * mesh.triangles, mesh.dots);
    this.mark.hidden = !(chosen && same(mesh));
    if (!this.mark.hidden) {
      const d = sub(chosen.kind === mesh.kind ? chosen.center : middle(mesh, chosen.triangle).center, cam.center);
      this.mark.style.left = `${50 + 50 * scale[0] * dot(axes[0], d)}%`;
      this.mark.style.top = `${50 - 50 * scale[1] * dot(axes[1], d)}%`;
    }
    c.dataset.view = [...cam.center, cam.half].join(' ');  // for tests, and for who saves the page
    c.dataset.drawn ||= Math.round(performance.now());
  }
  // the triangle in front at a place of the canvas, -1: none
  pick(event) {
    const box = this.canvas.getBoundingClientRect(), cam = this.camera, mesh = this.mesh, [right, up, back] = this.axes();
    const x = ((event.clientX - box.left) / box.width * 2 - 1) * this.half * box.width / box.height;
    const y = (1 - (event.clientY - box.top) / box.height * 2) * this.half;
    let best = -1, nearest = -Infinity;
    const flat = new Float64Array(3 * mesh.vertices), front = this.front;
    for (let v = 0; v < mesh.vertices; ++v) {
      const d = sub(place(mesh, v), cam.center);
      flat[3 * v] = dot(right, d) - x; flat[3 * v + 1] = dot(up, d) - y; flat[3 * v + 2] = dot(back, d);
    }
    for (let t = 0; t < mesh.triangles; ++t) {
      const [i, j, k] = [0, 1, 2].map(c => 3 * mesh.corners[3 * t + c]);
      const a = flat[j] * flat[k + 1] - flat[j + 1] * flat[k], b = flat[k] * flat[i + 1] - flat[k + 1] * flat[i], c = flat[i] * flat[j + 1] - flat[i + 1] * flat[j];
      if (!(a >= 0 && b >= 0 && c >= 0 || a <= 0 && b <= 0 && c <= 0) || a + b + c === 0) continue;
      const z = (a * flat[i + 2] + b * flat[j + 2] + c * flat[k + 2]) / (a + b + c);
      if (z > nearest && z <= front) nearest = z, best = t;
    }
    return best;
  }
  turn(dx, dy, pan) {
    const cam = this.camera;
    if (pan || this.own) {
      const [right, up] = this.axes(), unit = 2 * this.half / this.canvas.clientHeight;
      cam.center = cam.center.map((x, k) => x - unit * (dx * right[k] - dy * up[k]));
    } else {
      cam.azimuth -= 0.4 * dx;
      cam.elevation = Math.min(Math.max(cam.elevation + 0.4 * dy, -90), 90);
    }
    redraw();
  }
  zoom(factor) { this.camera.half *= factor; redraw(); }
  listen() {
    const c = this.canvas, held = new Map();
    let moved = 0;
    c.addEventListener('pointerdown', e => { held.set(e.pointerId, e); moved = 0; c.setPointerCapture(e.pointerId); });
    c.addEventListener('pointermove', e => {
      const last = held.get(e.pointerId);
      if (!last) return;
      const dx = e.clientX - last.clientX, dy = e.clientY - last.clientY, span = () => { const [a, b] = [...held.values()]; return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY); };
      moved += Math.abs(dx) + Math.abs(dy);
      const before = held.size === 2 ? span() : 0;
      held.set(e.pointerId, e);
      if (before > 0) { this.zoom(before / Math.max(span(), 1)); this.turn(dx / 2, dy / 2, true); }
      else this.turn(dx, dy, e.shiftKey || e.buttons & 6);
    });
    const release = e => {
      if (held.delete(e.pointerId) && e.type === 'pointerup' && moved < 4 && this.mesh) {
        const t = this.pick(e);
        if (t >= 0) choose(this.mesh, t, false);
      }
    };
    c.addEventListener('pointerup', release);
    c.addEventListener('pointercancel', release);
    c.addEventListener('contextmenu', e => e.preventDefault());
    c.addEventListener('wheel', e => { e.preventDefault(); this.zoom(1.0015 ** e.deltaY); }, {passive: false});
    c.addEventListener('keydown', e => {
      const arrow = {ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20]}[e.key];
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (arrow) this.turn(arrow[0], arrow[1], e.shiftKey);
      else if (e.key === '+' || e.key === '=') this.zoom(0.8);
      else if (e.key === '-') this.zoom(1.25);
      else if (e.key === 'Home') reset();
      else if (e.key === 'n') step(1);
      else if (e.key === 'p') step(-1);
      else return;
      e.preventDefault();
    });
  }
}

let camera = null, chosen = null, panes = [], waiting = 0, flying = 0;
function redraw() {
  document.body.dataset.busy = 'yes';  // for tests: until the camera rests
  waiting ||= requestAnimationFrame(() => {
    waiting = 0;
    for (const p of panes) p.draw();
    if (!flying) delete document.body.dataset.busy;
  });
}
function recolor() { for (const p of panes) p.recolor(); legend(); redraw(); }
// half the height of a view of this width over height, or more, in which the bounding box fits
const least_aspect = 1.2;
function fit(mesh) {
  const size = mesh.step.map(s => 32767.5 * s);
  if (flat(mesh)) return Math.max(size[1], size[0] / least_aspect);
  const rows = axes({azimuth: 30, elevation: 20}), extent = r => rows[r].reduce((sum, x, k) => sum + Math.abs(x) * size[k], 0);
  return Math.max(extent(1), extent(0) / least_aspect);
}
function whole(mesh) {
  return {center: mesh.low.map((x, k) => x + 32767.5 * mesh.step[k]), half: 1.08 * fit(mesh) || 1, azimuth: 30, elevation: 20};
}
function reset() {
  chosen = null;
  camera = whole((panes.find(p => p.mesh && !p.own) || panes[0]).mesh);
  for (const p of panes) if (p.own) p.own = {...whole(p.mesh), azimuth: -90, elevation: 90};
  say('The whole surface is in view.');
  recolor();
}
// a triangle of charts is that of the surface they map, and the other way round
const faces = mesh => meshes.indexOf(base(mesh));
const same = mesh => chosen.faces === faces(mesh);

function choose(mesh, t, fly) {
  const at = middle(mesh, t);
  chosen = {...at, triangle: t, faces: faces(mesh), kind: mesh.kind, flown: fly || chosen?.flown};
  const facts = mesh.columns.map(c => `${c.name} ${short(value(c, mesh.value[c.name][t]))}`);
  for (const l of mesh.labels) facts.push(`${l.name} ${l.names[mesh.label[l.name][t]]}`);
  const center = mesh.kind === 'result' && report.results[mesh.result].exact[t] || at.center;
  say(`${mesh.name}, triangle ${t}: ${facts.join(', ')}` + (flat(mesh) ? '' : `, at (${center.map(short).join(' ')})`));
  recolor();
  if (fly) for (const p of panes) if (p.mesh && same(p.mesh)) flyTo(p, p.mesh === mesh ? at : middle(p.mesh, t));
}
function flyTo(pane, at) {
  const cam = pane.camera, mesh = pane.mesh, from = {...cam};
  const [a, b, c] = corner(mesh, chosen.triangle), normal = cross(sub(b, a), sub(c, a)), length = Math.hypot(...normal);
  const to = {center: at.center, half: Math.max(8 * at.reach, 1e-4 * mesh.diagonal), azimuth: cam.azimuth, elevation: cam.elevation};
  if (!pane.own && length > 0) {  // from outside
    to.azimuth = Math.atan2(normal[1], normal[0]) * 180 / Math.PI;
    to.elevation = Math.max(-80, Math.min(80, Math.asin(normal[2] / length) * 180 / Math.PI));
    to.azimuth += 360 * Math.round((from.azimuth - to.azimuth) / 360);
  }
  ++flying;
  const start = performance.now(), mine = cam.flight = (cam.flight || 0) + 1, lasts = calm ? 1 : 500;
  const frame = () => {
    const x = Math.min((performance.now() - start) / lasts, 1), s = x * x * (3 - 2 * x);
    cam.center = from.center.map((v, k) => v + s * (to.center[k] - v));
    cam.half = from.half * (to.half / from.half) ** s;
    cam.azimuth = from.azimuth + s * (to.azimuth - from.azimuth);
    cam.elevation = from.elevation + s * (to.elevation - from.elevation);
    const goes = x < 1 && mine === cam.flight;  // else another flight of this camera has begun
    if (goes) requestAnimationFrame(frame);
    else --flying;
    redraw();
  };
  frame();
}
async function go(result, t) {
  let pane = panes.find(p => p.mesh?.result === result && p.mesh.kind === 'result');
  if (!pane) {
    pane = panes[0];
    const i = meshes.findIndex(m => m.result === result && m.kind === 'result');
    pane.select.value = i;
    await pane.show(meshes[i]);
    camera = whole(meshes[i]);
  }
  $('viewer').scrollIntoView({behavior: calm ? 'auto' : 'smooth', block: 'nearest'});
  choose(pane.mesh, t, true);
}
function step(by) {
  const mesh = panes.find(p => p.mesh?.kind === 'result')?.mesh;
  if (!mesh) return;
  const r = report.results[mesh.result], list = r.offending.length ? r.offending : r.worst;
  if (!list.length) return;
  const now = chosen ? list.indexOf(chosen.triangle) : -1;
  go(mesh.result, list[now < 0 ? (by > 0 ? 0 : list.length - 1) : (now + by + list.length) % list.length]);
}

async function begin() {
  if (!meshes.length) throw new Error('there are no triangles');
  const faulty = Promise.all(report.results.map(async (r, i) => { r.offending = await inflated('faulty' + i).json(); }));
  panes = [...document.querySelectorAll('.pane')].map(root => new Pane(root));
  $('viewer').hidden = false;
  $('stills').hidden = true;
  panes.forEach((pane, k) => {
    if (k > 0) pane.select.append(new Option('nothing', -1));
    meshes.forEach((m, i) => pane.select.append(new Option(m.name, i)));
    pane.select.addEventListener('change', async () => {
      const before = panes[0].mesh?.result;
      await pane.show(meshes[pane.select.value]);
      pane.root.hidden = false;
      if (k === 0 && pane.mesh.result !== before) reset();
      else recolor();
    });
  });
  const beside = meshes.findIndex((m, i) => i > 0 && m.result === meshes[0].result);
  await panes[0].show(meshes[0]);
  await faulty;
  camera = whole(meshes[0]);
  const kinds = new Set(meshes.flatMap(m => [...m.columns, ...m.labels].map(c => c.name)));
  for (const k of [...kinds, 'nothing']) $('color').append(new Option(k, k));
  const charts = meshes.some(flat);
  if (charts && kinds.has('part')) $('color').value = 'part';
  colorBy = $('color').value;
  recolor();
  // first the picture, then the second mesh; in a tab that is hidden there is no frame to wait for
  await new Promise(done => { requestAnimationFrame(() => setTimeout(done)); setTimeout(done, 300); });
  panes[1].select.value = beside;
  await panes[1].show(meshes[beside]);
  panes[1].root.hidden = false;
  recolor();
  $('color').addEventListener('change', () => { colorBy = $('color').value; recolor(); });
  $('wire').addEventListener('change', redraw);
  $('reset').addEventListener('click', reset);
  $('next').addEventListener('click', () => step(1));
  $('prev').addEventListener('click', () => step(-1));
  addEventListener('resize', redraw);
  addEventListener('beforeprint', () => { for (const p of panes) if (p.mesh) { p.draw(); p.still.src = p.canvas.toDataURL(); } });
  for (const b of document.querySelectorAll('button[data-t]')) b.disabled = false;
}
// the rows of a table of triangles that the page holds packed
async function rest(button) {
  button.closest('section').querySelector('table.faults tbody').insertAdjacentHTML('beforeend', await inflated('rows' + button.dataset.all).text());
  for (const b of document.querySelectorAll('button[data-t]')) b.disabled = $('viewer').hidden;
  button.remove();
}
document.addEventListener('click', e => {
  const b = e.target.closest('button[data-t]');
  if (b) go(+b.dataset.result, +b.dataset.t);
  const all = e.target.closest('button[data-all]');
  if (all) rest(all);
});
for (const b of document.querySelectorAll('button[data-all]')) b.disabled = false;
begin().catch(e => {
  $('viewer').hidden = true;
  $('stills').hidden = false;
  $('why').textContent = `The surface cannot be shown in three dimensions here (${e.message})` + (meshes.length ? '; this is a picture of it, and the buttons that lead to triangles are off.' : '.');
});
})();
