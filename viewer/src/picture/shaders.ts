// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Shaders of disks, triangles, points and scans, and of the final picture.

/** Values of the uniform color_mode. */
export const kColorModes = [
  'class',
  'intensity',
  'normal',
  'shading',
  'height',
  'error',
  'rgb',
] as const;
export type ColorMode = (typeof kColorModes)[number];

/** Values of the uniform scan_mode. */
export const kScanModes = ['range', 'class', 'intensity', 'ring'] as const;
export type ScanMode = (typeof kScanModes)[number];

const kPrelude = /* glsl */ `
precision highp float;
precision highp int;
`;

/** The clipping box (clip.ts). */
const kClip = /* glsl */ `
uniform int clip_mode;      // 1: keep inside, 2: keep outside
uniform mat4 clip_from_world;
bool is_clipped(vec3 world) {
  if (clip_mode == 0) return false;
  vec3 p = abs((clip_from_world * vec4(world, 1.0)).xyz);
  return (max(p.x, max(p.y, p.z)) <= 1.0) != (clip_mode == 1);
}
`;

/** Decodes and colours an element (16 bytes of nodes/N.bin). Colours are in screen space. */
const kElement = /* glsl */ `
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
uniform vec3 cameraPosition;
uniform sampler2D classes, maps;
uniform int color_mode;
uniform int has;            // 1: classes, 2: intensities, 4: errors, 8: signed errors, 16: holes,
                            // 32: colours
uniform vec2 height_range_m;
uniform int one_class;      // class of all elements of an object; -1: class per element
uniform vec3 low, size;
in uvec4 element;
in vec4 rgb;
flat out vec3 color;

// World position: modelMatrix places objects, and is the identity for layers of the scene.
vec3 element_position() {
  uvec3 q = uvec3(element.x & 0xffffu, element.x >> 16, element.y & 0xffffu);
  return (modelMatrix * vec4(low + size * vec3(q) / 65535.0, 1.0)).xyz;
}

vec3 element_normal() {
  vec2 p = vec2(float(int(element.z << 16) >> 16), float(int(element.z) >> 16)) / 32767.0;
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) {
    vec2 s = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    n.xy = (1.0 - abs(p.yx)) * s;
  }
  return normalize(mat3(modelMatrix) * n);
}

vec4 class_texel() {
  int id = one_class >= 0 ? one_class : int(element.w & 0xffffu);
  return texelFetch(classes, ivec2(id & 255, id >> 8), 0);
}

// Row r of the colour maps: an index of kRoles in color_maps.ts.
vec3 map_color(int r, float t) {
  float x = (0.5 + 255.0 * clamp(t, 0.0, 1.0)) / 256.0;
  return texture(maps, vec2(x, (float(r) + 0.5) / 4.0)).rgb;
}

const vec3 kPlain = vec3(0.74, 0.77, 0.80);
const vec3 kUnknown = vec3(0.36, 0.38, 0.41);
const vec3 kHole = vec3(0.98, 0.86, 0.10);

vec3 base_color(vec3 position, vec3 normal) {
  if (color_mode == 0) return (has & 1) != 0 ? class_texel().rgb : kPlain;
  if (color_mode == 1)
    return (has & 2) != 0 ? map_color(2, 0.12 + 0.88 * float((element.w >> 16) & 255u) / 255.0)
                          : kUnknown;
  if (color_mode == 2) return 0.5 + 0.5 * normal;
  if (color_mode == 6) return (has & 32) != 0 ? rgb.rgb : kPlain;
  if (color_mode == 4)
    return map_color(0, (position.z - height_range_m.x) / (height_range_m.y - height_range_m.x));
  if (color_mode == 5) {
    uint code = element.w >> 24;
    if ((has & 4) == 0 || code == 0u) return (has & 16) != 0 ? kHole : kUnknown;
    return map_color((has & 8) != 0 ? 3 : 1, float(code - 1u) / 254.0);
  }
  return kPlain;
}

bool hidden() { return (has & 1) != 0 && class_texel().a < 0.5; }

// A headlight and sky light: they show the shape in every mode without changing hues.
float light(vec3 normal, vec3 to_eye) {
  float head = abs(dot(normal, to_eye));
  float sky = 0.5 + 0.5 * (dot(normal, to_eye) < 0.0 ? -normal.z : normal.z);
  return color_mode == 3 ? 0.16 + 0.56 * head + 0.30 * sky : 0.46 + 0.34 * head + 0.22 * sky;
}

const vec4 kNowhere = vec4(2.0, 2.0, 2.0, 1.0);
`;

/**
 * A disk is drawn as a square pyramid. In depth only, its tip is shifted towards the camera: where
 * disks of a surface overlap, each is visible around its own center, and nothing flickers.
 */
export const kDiskVertex =
  kPrelude +
  kElement +
  /* glsl */ `
uniform float largest_radius_m;
in vec2 corner;
out vec2 offset;
out vec3 world;
const float kTip = 0.12;    // of the radius

void main() {
  vec3 center = element_position();
  vec3 n = element_normal();
  float radius = largest_radius_m * float(element.y >> 16) / 65535.0 * length(modelMatrix[0].xyz);
  if (hidden()) { gl_Position = kNowhere; return; }
  vec3 other = abs(n.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  vec3 u = normalize(cross(n, other));
  vec3 position = center + radius * (corner.x * u + corner.y * cross(n, u));
  world = position;
  vec4 seen = viewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  if (corner == vec2(0.0)) {
    float depth = max(-seen.z - kTip * radius, -0.9 * seen.z);
    gl_Position.z = (projectionMatrix[3][2] - depth * projectionMatrix[2][2]) / depth * -seen.z;
  }
  offset = corner;
  vec3 base = base_color(center, n);
  color = color_mode == 2 ? base : base * light(n, normalize(cameraPosition - center));
}
`;

/** A triangle of a mesh with its own class and intensity, visible from both sides. */
export const kTriangleVertex =
  kPrelude +
  kElement.replace('in uvec4 element;', 'in uvec3 a, b, c;\nin uint attributes;\nuvec4 element;') +
  /* glsl */ `
in float corner;
out vec2 offset;
out vec3 world;

void main() {
  element = uvec4(0u, 0u, 0u, attributes);
  if (hidden()) { gl_Position = kNowhere; return; }
  vec3 p = (modelMatrix * vec4(uintBitsToFloat(a), 1.0)).xyz;
  vec3 q = (modelMatrix * vec4(uintBitsToFloat(b), 1.0)).xyz;
  vec3 r = (modelMatrix * vec4(uintBitsToFloat(c), 1.0)).xyz;
  vec3 n = cross(q - p, r - p);
  n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0, 0.0, 1.0);
  vec3 center = (p + q + r) / 3.0;
  world = corner < 0.5 ? p : corner < 1.5 ? q : r;
  gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
  offset = vec2(0.0);
  vec3 base = base_color(world, n);
  color = color_mode == 2 ? base : base * light(n, normalize(cameraPosition - center));
}
`;

export const kDiskFragment =
  kPrelude +
  kClip +
  /* glsl */ `
flat in vec3 color;
in vec2 offset;
in vec3 world;
out vec4 pixel;
void main() {
  if (dot(offset, offset) > 1.0 || is_clipped(world)) discard;
  pixel = vec4(color, 1.0);
}
`;

export const kPointVertex =
  kPrelude +
  kElement +
  kClip +
  /* glsl */ `
uniform float point_px, spacing_m, focal_px;

void main() {
  vec3 center = element_position();
  if (hidden() || is_clipped(center)) { gl_Position = kNowhere; return; }
  vec4 seen = viewMatrix * vec4(center, 1.0);
  gl_Position = projectionMatrix * seen;
  gl_PointSize = clamp(max(point_px, 0.7 * spacing_m * focal_px / -seen.z), 1.0, 24.0);
  color = base_color(center, vec3(0.0, 0.0, 1.0));
}
`;

/** Round points, of layers and of scans. */
export const kPointFragment =
  kPrelude +
  /* glsl */ `
flat in vec3 color;
out vec4 pixel;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  if (dot(p, p) > 1.0) discard;
  pixel = vec4(color, 1.0);
}
`;

/** A point of a scan packet (24 bytes), drawn slightly in front of its surface. */
export const kScanVertex =
  kPrelude +
  kClip +
  /* glsl */ `
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
uniform sampler2D classes, maps;
uniform int scan_mode, is_plain, has;
uniform float point_px, rings, max_range_m;
in uvec3 point;
in uvec3 echo;              // ring and class, column, intensity and return
flat out vec3 color;

vec3 map_color(int r, float t) {
  float x = (0.5 + 255.0 * clamp(t, 0.0, 1.0)) / 256.0;
  return texture(maps, vec2(x, (float(r) + 0.5) / 4.0)).rgb;
}

void main() {
  vec3 position = uintBitsToFloat(point);
  vec4 world = modelMatrix * vec4(position, 1.0);
  if (is_clipped(world.xyz)) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec4 seen = viewMatrix * world;
  seen.xyz *= 1.0 - min(0.02, 0.2 / max(-seen.z, 1e-3));
  gl_Position = projectionMatrix * seen;
  gl_PointSize = point_px;
  int id = int(echo.x >> 16);
  if (is_plain != 0) color = vec3(1.0, 0.62, 0.25);
  else if (scan_mode == 1 && (has & 1) != 0)
    color = texelFetch(classes, ivec2(id & 255, id >> 8), 0).rgb;
  else if (scan_mode == 2) color = map_color(2, 0.15 + 0.85 * float(echo.z & 0xffffu) / 65535.0);
  else if (scan_mode == 3) color = map_color(1, float(echo.x & 0xffffu) / max(rings - 1.0, 1.0));
  // Square root: most returns are close.
  else color = map_color(0, 0.15 + 0.85 * sqrt(length(position) / max_range_m));
}
`;

export const kScreenVertex = /* glsl */ `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

/** One pixel's depth in 24 bits. */
export const kDepthFragment =
  kPrelude +
  /* glsl */ `
uniform sampler2D depths;
uniform vec2 at;
out vec4 pixel;
void main() {
  uint depth = uint(texelFetch(depths, ivec2(at), 0).r * 16777215.0);
  pixel = vec4(uvec3(depth >> 16, (depth >> 8) & 255u, depth & 255u), 255u) / 255.0;
}
`;

/** The model's picture with its depth and darkened edges (eye-dome lighting, Boucheny 2009). */
export const kScreenFragment =
  kPrelude +
  /* glsl */ `
uniform sampler2D picture, depths;
uniform vec2 near_far, pixels;
uniform float outline, pixel_ratio;
out vec4 pixel;

float log_depth(ivec2 at) {
  float z = texelFetch(depths, clamp(at, ivec2(0), ivec2(pixels) - 1), 0).r;
  float depth = near_far.x * near_far.y / (near_far.y - z * (near_far.y - near_far.x));
  return z >= 1.0 ? 40.0 : log2(depth);
}

vec3 background(float t) { return mix(vec3(0.043, 0.051, 0.063), vec3(0.106, 0.125, 0.149), t); }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float z = texelFetch(depths, at, 0).r;
  gl_FragDepth = z;
  vec3 color = z >= 1.0 ? background(gl_FragCoord.y / pixels.y) : texelFetch(picture, at, 0).rgb;
  if (outline > 0.0) {
    float own = log_depth(at);
    int r = int(max(1.0, pixel_ratio));
    float sum = max(0.0, own - log_depth(at + ivec2(r, 0))) +
                max(0.0, own - log_depth(at - ivec2(r, 0))) +
                max(0.0, own - log_depth(at + ivec2(0, r))) +
                max(0.0, own - log_depth(at - ivec2(0, r)));
    // The background gets a rim, not a shadow.
    color *= z >= 1.0 ? 1.0 : max(0.35, exp(-outline * sum));
  }
  pixel = vec4(color, 1.0);
}
`;
