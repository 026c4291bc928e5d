// WebGL2: each ball is a square that is turned to the eye, in which a ray is cast at the sphere. So a ball is round at
// every size, and its texture shows how it is turned.

const kThrough = 0.3; // of its colour: how an arrow behind a ball is seen

// A ball is drawn at least as wide as three pixels, so that none is too small to be seen.
const kBallVertex = `#version 300 es
layout(location=0) in vec4 sphere;
layout(location=1) in vec4 turned;
layout(location=2) in vec4 colour;
layout(location=3) in vec2 look;
uniform mat4 view, projection;
uniform float flatView, pixel;
out vec3 at;
flat out vec3 centre;
flat out float radius;
flat out vec4 q, tint;
flat out vec2 shape;
void main() {
  centre = (view * vec4(sphere.xyz, 1.0)).xyz;
  radius = max(sphere.w, 1.5 * pixel * (flatView > 0.5 ? 1.0 : length(centre)));
  q = turned; tint = colour; shape = look;
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vec3 z = flatView > 0.5 ? vec3(0.0, 0.0, -1.0) : normalize(centre);
  vec3 x = normalize(cross(z, abs(z.y) < 0.99 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
  vec3 y = cross(x, z);
  float away = flatView > 0.5 ? 1.0 : length(centre);
  float grown = flatView > 0.5 ? 1.0 : away / sqrt(max(away * away - radius * radius, 1e-4 * away * away));
  float edge = pixel * (flatView > 0.5 ? 1.0 : away);
  at = centre + (radius * grown * 1.02 + 2.0 * edge) * (corner.x * x + corner.y * y);
  gl_Position = projection * vec4(at, 1.0);
}`;

const kBallFragment = `#version 300 es
precision highp float;
in vec3 at;
flat in vec3 centre;
flat in float radius;
flat in vec4 q, tint;
flat in vec2 shape;
uniform mat4 projection;
uniform float flatView, pixel;
uniform vec3 ink;
out vec4 paint;
vec3 back(vec3 n) { return n + 2.0 * cross(-q.xyz, cross(-q.xyz, n) + q.w * n); }
uniform mat4 view;
void main() {
  vec3 toward = flatView > 0.5 ? vec3(0.0, 0.0, -1.0) : normalize(at);
  vec3 from = flatView > 0.5 ? vec3(at.xy, 0.0) : vec3(0.0);
  vec3 away = centre - from;
  float along = dot(away, toward);
  vec3 nearest = away - along * toward;
  float miss = length(nearest);
  float edge = pixel * (flatView > 0.5 ? 1.0 : along);
  float cover = clamp((radius - miss) / edge + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float deep = sqrt(max(radius * radius - miss * miss, 0.0));
  vec3 hit = from + (along - deep) * toward;
  vec3 n = normalize(hit - centre);
  vec3 c = tint.rgb;
  if (shape.x > 0.5) {
    vec3 m = back(transpose(mat3(view)) * n);
    float sector = fract(atan(m.x, m.z) * 0.954929658551372 * 0.5);
    float polar = step(0.9, abs(m.y));
    c = mix(sector < 0.5 ? c : mix(c, vec3(1.0), 0.78), m.y > 0.0 ? vec3(0.12) : vec3(0.95), polar);
  }
  float light = 0.62 + 0.38 * max(dot(n, normalize(vec3(-0.45, 0.6, 0.66))), 0.0);
  float shine = pow(max(dot(reflect(-normalize(vec3(-0.45, 0.6, 0.66)), n), -toward), 0.0), 40.0);
  c = c * light + 0.22 * shine;
  float rim = (radius - miss) / edge;
  c = mix(c, ink, (1.0 - smoothstep(0.6, 1.6, rim)) * 0.55);
  if (shape.y > 0.5) {
    float ring = max(0.16 * radius / edge, 2.5);
    c = mix(c, ink, 1.0 - smoothstep(ring - 1.0, ring, rim));
  }
  vec4 clip = projection * vec4(hit, 1.0);
  gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0);
  paint = vec4(c, 1.0) * (tint.a * cover);
}`;

const kStrokeVertex = `#version 300 es
layout(location=0) in vec3 from;
layout(location=1) in vec3 to;
layout(location=2) in vec3 widths;
layout(location=3) in vec4 colour;
uniform mat4 view, projection;
uniform vec2 size;
uniform float scale, haloed, fade;
out vec4 tint;
out float across, half_px;
flat out float halo;
void main() {
  vec4 a = projection * view * vec4(from, 1.0);
  vec4 b = projection * view * vec4(to, 1.0);
  float close = 1e-4;
  if (a.w < close) a = mix(a, b, (close - a.w) / max(b.w - a.w, 1e-9));
  if (b.w < close) b = mix(b, a, (close - b.w) / max(a.w - b.w, 1e-9));
  vec2 pa = a.xy / a.w * size, pb = b.xy / b.w * size;
  vec2 way = pb - pa;
  vec2 normal = length(way) > 1e-6 ? normalize(vec2(-way.y, way.x)) : vec2(0.0, 1.0);
  bool end = (gl_VertexID & 1) == 1;
  float side = gl_VertexID > 1 ? 1.0 : -1.0;
  vec4 p = end ? b : a;
  halo = haloed * scale * widths.z;
  half_px = 0.5 * scale * (end ? widths.y : widths.x) + halo + 0.7;
  across = side * half_px;
  tint = vec4(colour.rgb, fade * colour.a);
  p.xy += side * normal * half_px / size * p.w;
  p.z -= 1e-4 * p.w;
  gl_Position = p;
}`;

const kStrokeFragment = `#version 300 es
precision highp float;
in vec4 tint;
in float across, half_px;
flat in float halo;
uniform vec3 paper;
out vec4 paint;
void main() {
  float inside = half_px - abs(across) + 0.2;
  vec3 c = mix(paper, tint.rgb, halo > 0.0 ? clamp(inside - halo, 0.0, 1.0) : 1.0);
  paint = vec4(c, 1.0) * (tint.a * clamp(inside, 0.0, 1.0));
}`;

const kSheetVertex = `#version 300 es
layout(location=0) in vec3 corner;
layout(location=1) in vec4 colour;
uniform mat4 view, projection;
out vec4 tint;
void main() { tint = colour; gl_Position = projection * view * vec4(corner, 1.0); }`;

const kSheetFragment = `#version 300 es
precision highp float;
in vec4 tint;
out vec4 paint;
void main() { paint = vec4(tint.rgb, 1.0) * tint.a; }`;

/** A program with one array of numbers; `parts` are the sizes of its inputs. */
class Brush {
  constructor(gl, vertex, fragment, parts, instanced) {
    this.gl = gl;
    this.parts = parts;
    this.stride = parts.reduce((sum, x) => sum + x, 0);
    this.instanced = instanced;
    this.program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
        throw new Error(gl.getShaderInfoLog(shader));
      }
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getProgramInfoLog(this.program));
    }
    this.places = new Map();
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    let at = 0;
    parts.forEach((size, index) => {
      gl.enableVertexAttribArray(index);
      gl.vertexAttribPointer(index, size, gl.FLOAT, false, 4 * this.stride, 4 * at);
      if (instanced) gl.vertexAttribDivisor(index, 1);
      at += size;
    });
  }

  set(name, value) {
    const { gl } = this;
    if (!this.places.has(name)) this.places.set(name, gl.getUniformLocation(this.program, name));
    const place = this.places.get(name);
    if (typeof value === "number") gl.uniform1f(place, value);
    else if (value.length === 16) gl.uniformMatrix4fv(place, false, value);
    else if (value.length === 3) gl.uniform3fv(place, value);
    else gl.uniform2fv(place, value);
  }

  /** @param rows  numbers, and the count of rows that are drawn; nothing: those of before once more */
  draw(rows, uniforms) {
    const { gl } = this;
    if (rows) this.count = rows.count;
    const { count } = this;
    if (count === 0) return;
    gl.useProgram(this.program);
    for (const name in uniforms) this.set(name, uniforms[name]);
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    if (rows) gl.bufferData(gl.ARRAY_BUFFER, rows.numbers, gl.DYNAMIC_DRAW, 0, count * this.stride);
    if (this.instanced) gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    else gl.drawArrays(gl.TRIANGLES, 0, count);
  }
}

function sheetRows(sheets) {
  const numbers = [];
  for (const { corners, colour, alpha } of sheets) {
    for (const k of [0, 1, 2, 0, 2, 3]) numbers.push(...corners[k], ...colour, alpha);
  }
  return { numbers: new Float32Array(numbers), count: 6 * sheets.length };
}

export class PaintGl {
  static name = "webgl2";

  /** @returns null where there is no WebGL2 */
  static on(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, powerPreference: "low-power" });
    if (!gl || gl.isContextLost()) return null;
    try {
      return new PaintGl(canvas, gl);
    } catch (error) {
      console.warn(error);
      return null;
    }
  }

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.balls = new Brush(gl, kBallVertex, kBallFragment, [4, 4, 4, 2], true);
    this.strokes = new Brush(gl, kStrokeVertex, kStrokeFragment, [3, 3, 3, 4], true);
    this.sheets = new Brush(gl, kSheetVertex, kSheetFragment, [3, 4], false);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthFunc(gl.LEQUAL);
  }

  begin(theme) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.depthMask(true);
    gl.clearColor(...theme.paper, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  /** @param part  left, top, width, height in pixels of the canvas */
  paint(picture, camera, part, theme, offset, scale) {
    const { gl, canvas } = this;
    const bottom = canvas.height - part.top - part.height;
    gl.viewport(part.left, bottom, part.width, part.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(part.left, bottom, part.width, part.height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    const { view, projection, half, distance } = camera.matrices(part.width / part.height, offset, picture.origin);
    const pixel = 2 * half / part.height / (camera.flat ? 1 : distance);
    const common = { view, projection };
    const ballLook = { ...common, flatView: camera.flat ? 1 : 0, pixel, ink: theme.ink };
    const strokeLook = { ...common, size: [0.5 * part.width, 0.5 * part.height], scale, paper: theme.paper, haloed: 1, fade: 1 };
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    this.balls.draw(picture.balls, ballLook);
    this.strokes.draw(picture.strokes, strokeLook);
    gl.depthMask(false);
    this.balls.draw(picture.ghosts, ballLook);
    this.sheets.draw(sheetRows(picture.sheets), common);
    if (!camera.flat) this.strokes.draw(picture.arrows, strokeLook);
    gl.disable(gl.DEPTH_TEST);
    // In the plane nothing hides an arrow; in space what is behind balls shines through.
    if (camera.flat) this.strokes.draw(picture.arrows, strokeLook);
    else if (picture.arrows.count > 0) this.strokes.draw(null, { ...strokeLook, haloed: 0, fade: kThrough });
    this.strokes.draw(picture.fronts, strokeLook);
    gl.depthMask(true);
  }

  finish() {
    this.gl.finish();
  }

  close() {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}
