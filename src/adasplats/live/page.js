// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Shows the scans of `adasplats serve-sensor` in the frame of the vehicle (docs/live.md).
'use strict';

const $ = (id) => document.getElementById(id);
const clouds = new Map();  // by topic: {buffer, count, mount}
let state = null;

// --- requests

async function request(method, path, body) {
  const reply = await fetch(path, {method, body: body && JSON.stringify(body)});
  const json = await reply.json();
  $('error').textContent = json.error ?? '';
  if (json.streams) showState(json);
  else if (reply.ok) request('GET', 'state');
}

function showState(json) {
  state = json;
  $('run').textContent = state.running ? 'Pause' : 'Run';
  $('step').disabled = state.running;
  const late = state.streams.late_ms;
  const facts = {
    'time': `${state.time_s.toFixed(2)} s, step ${state.steps}`,
    'sensors': state.sensors.map((s) => `${s.name} (${s.model}, ${s.rotation_hz} Hz)`).join(', '),
    'points': state.sensors.reduce((sum, sensor) => sum + (sensor.points ?? 0), 0).toLocaleString('en'),
    'objects': state.objects.length,
    'late steps': state.streams.late_steps,
    'delay': `median ${late.median.toFixed(2)} ms, 99 % below ${late.p99.toFixed(2)} ms`,
  };
  if (state.streams.packets) facts.packets = state.streams.packets.toLocaleString('en');
  $('facts').replaceChildren(...Object.entries(facts).map(([name, value]) => {
    const row = document.createElement('tr');
    row.insertCell().textContent = name;
    row.insertCell().textContent = value;
    return row;
  }));
}

$('run').onclick = () => request('POST', 'run', {on: !state.running});
$('step').onclick = () => request('POST', 'step', {count: 1});
setInterval(() => request('GET', 'state'), 500);
request('GET', 'state');

// --- messages

/// Reads sensor_msgs/msg/PointCloud2 in CDR.
function readCloud(view) {
  let at = 4;
  const u32 = () => {
    at = 4 + Math.ceil((at - 4) / 4) * 4;
    return view.getUint32((at += 4) - 4, true);
  };
  const text = () => {
    const size = u32();
    at += size;
    return new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + at - size, size - 1));
  };
  u32(), u32(), text();  // header
  const count = u32() * u32();
  const fields = {};
  for (let left = u32(); left > 0; --left) {
    const name = text(), offset = u32(), type = view.getUint8(at++);
    u32();
    fields[name] = {offset, type};
  }
  ++at;  // is_bigendian
  const step = u32();
  u32(), u32();  // row_step, size of the data
  return {count, fields, step, begin: at};
}

/// x, y, z, intensity and label of each point.
function pointsOf(view) {
  const cloud = readCloud(view), values = new Float32Array(5 * cloud.count);
  const read = {2: (at) => view.getUint8(at), 4: (at) => view.getUint16(at, true), 7: (at) => view.getFloat32(at, true)};
  ['x', 'y', 'z', 'intensity', 'label'].forEach((name, k) => {
    const field = cloud.fields[name];
    if (!field) return;
    for (let i = 0; i < cloud.count; ++i)
      values[5 * i + k] = read[field.type](cloud.begin + i * cloud.step + field.offset);
  });
  return values;
}

function connect() {
  const socket = new WebSocket(location.href.replace(/^http/, 'ws') + 'live', 'foxglove.websocket.v1');
  const topics = [];
  socket.binaryType = 'arraybuffer';
  socket.onmessage = ({data}) => {
    if (typeof data === 'string') {
      const message = JSON.parse(data);
      if (message.op !== 'advertise') return;
      const wanted = message.channels.filter((channel) => channel.schemaName === 'sensor_msgs/msg/PointCloud2');
      wanted.forEach((channel) => topics[channel.id] = channel.topic);
      socket.send(JSON.stringify({op: 'subscribe', subscriptions: wanted.map(({id}) => ({id, channelId: id}))}));
      return;
    }
    const view = new DataView(data);
    if (view.getUint8(0) === 1) upload(topics[view.getUint32(1, true)], pointsOf(new DataView(data, 13)));
  };
  socket.onclose = () => setTimeout(connect, 1000);
}

// --- drawing

const gl = $('view').getContext('webgl');
const camera = {yaw: -2.4, pitch: 0.5, distance: 45};

const shader = (type, source) => {
  const made = gl.createShader(type);
  gl.shaderSource(made, source);
  gl.compileShader(made);
  return made;
};
const program = gl.createProgram();
gl.attachShader(program, shader(gl.VERTEX_SHADER, `
  attribute vec3 position; attribute float intensity; attribute float label;
  uniform vec4 turn; uniform vec3 shift; uniform mat4 project; uniform float highest; uniform int by;
  varying vec3 color;
  vec3 ramp(float t) { t = clamp(t, 0.0, 1.0); return clamp(vec3(1.7 * t - 0.3, 0.2 + 0.75 * t, 0.75 - 0.55 * t), 0.0, 1.0); }
  void main() {
    vec3 p = position + 2.0 * cross(turn.xyz, cross(turn.xyz, position) + turn.w * position) + shift;
    if (by == 0) color = ramp((p.z + 2.5) / 6.0);
    else if (by == 1) color = ramp(intensity / highest);
    else color = 0.35 + 0.6 * fract(label * vec3(0.618, 0.345, 0.127));
    gl_Position = project * vec4(p, 1.0);
    gl_PointSize = 1.6;
  }`));
gl.attachShader(program, shader(gl.FRAGMENT_SHADER,
  'precision mediump float; varying vec3 color; void main() { gl_FragColor = vec4(color, 1.0); }'));
gl.linkProgram(program);
gl.useProgram(program);
const uniform = (name) => gl.getUniformLocation(program, name);
['position', 'intensity', 'label'].forEach((name) => gl.enableVertexAttribArray(gl.getAttribLocation(program, name)));

function upload(topic, values) {
  const cloud = clouds.get(topic) ?? {buffer: gl.createBuffer(), highest: 1e-6};
  clouds.set(topic, cloud);
  cloud.count = values.length / 5;
  for (let i = 3; i < values.length; i += 5) if (values[i] > cloud.highest) cloud.highest = values[i];
  gl.bindBuffer(gl.ARRAY_BUFFER, cloud.buffer);
  gl.bufferData(gl.ARRAY_BUFFER, values, gl.STREAM_DRAW);
  requestAnimationFrame(draw);
}

/// Clip space from the vehicle's frame: a camera that looks at the vehicle from a distance.
function projection(aspect) {
  const {yaw, pitch, distance} = camera, near = 0.5, far = 1000, f = 1.6;
  const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  const right = [-sy, cy, 0], up = [-sp * cy, -sp * sy, cp], back = [cp * cy, cp * sy, sp];
  const a = (far + near) / (near - far), b = 2 * far * near / (near - far);
  const rows = [right.map((v) => v * f / aspect).concat(0), up.map((v) => v * f).concat(0),
                back.map((v) => v * a).concat(-distance * a + b), back.map((v) => -v).concat(distance)];
  return [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));
}

function draw() {
  const canvas = gl.canvas;
  canvas.width = canvas.clientWidth * devicePixelRatio;
  canvas.height = canvas.clientHeight * devicePixelRatio;
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.enable(gl.DEPTH_TEST);
  gl.clearColor(0.08, 0.09, 0.11, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.uniformMatrix4fv(uniform('project'), false, projection(canvas.width / canvas.height));
  gl.uniform1i(uniform('by'), $('color').selectedIndex);
  for (const [topic, cloud] of clouds) {
    const sensor = state?.sensors.find((one) => one.topic === topic);
    const [x, y, z, qx, qy, qz, qw] = sensor?.vehicle_from_points ?? [0, 0, 0, 0, 0, 0, 1];
    gl.uniform3f(uniform('shift'), x, y, z);
    gl.uniform4f(uniform('turn'), qx, qy, qz, qw);
    gl.uniform1f(uniform('highest'), cloud.highest);
    gl.bindBuffer(gl.ARRAY_BUFFER, cloud.buffer);
    [['position', 3, 0], ['intensity', 1, 12], ['label', 1, 16]].forEach(([name, size, offset]) =>
      gl.vertexAttribPointer(gl.getAttribLocation(program, name), size, gl.FLOAT, false, 20, offset));
    gl.drawArrays(gl.POINTS, 0, cloud.count);
  }
}

$('view').onpointermove = (event) => {
  if (!event.buttons) return;
  camera.yaw -= event.movementX / 200;
  camera.pitch = Math.min(1.55, Math.max(-0.2, camera.pitch + event.movementY / 200));
  draw();
};
$('view').onwheel = (event) => {
  camera.distance = Math.min(400, Math.max(3, camera.distance * Math.exp(event.deltaY / 1000)));
  draw();
};
$('color').onchange = draw;
onresize = draw;
connect();
