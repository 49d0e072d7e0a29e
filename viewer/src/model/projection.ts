/** Directions on an equal-area map of the sphere (Mollweide): x in [-2, 2], y in [-1, 1], z up in the middle column. */

/** Unit direction to map coordinates. */
export function toMap(x: number, y: number, z: number): { u: number; v: number } {
  const longitude = Math.atan2(y, x);
  const latitude = Math.asin(Math.max(-1, Math.min(1, z)));
  // Newton on 2 theta + sin 2 theta = pi sin latitude; at the poles theta is the latitude.
  let theta = latitude;
  if (Math.abs(latitude) < Math.PI / 2 - 1e-6) {
    for (let i = 0; i < 30; ++i) {
      const f = 2 * theta + Math.sin(2 * theta) - Math.PI * Math.sin(latitude);
      const step = f / (2 + 2 * Math.cos(2 * theta));
      theta -= step;
      if (Math.abs(step) < 1e-9) break;
    }
  }
  return { u: (2 * longitude * Math.cos(theta)) / Math.PI, v: Math.sin(theta) };
}

/** Map coordinates to a unit direction, null outside of the map. */
export function fromMap(u: number, v: number): [number, number, number] | null {
  if ((u * u) / 4 + v * v > 1) return null;
  const theta = Math.asin(v);
  const latitude = Math.asin(Math.max(-1, Math.min(1, (2 * theta + Math.sin(2 * theta)) / Math.PI)));
  const longitude = (Math.PI * u) / (2 * Math.max(1e-9, Math.cos(theta)));
  if (Math.abs(longitude) > Math.PI + 1e-6) return null;
  return [Math.cos(latitude) * Math.cos(longitude), Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)];
}

/** For every pixel of a `width` x `height` map the nearest of the directions (three numbers each), -1 outside. */
export function nearestMap(directions: Float32Array, width: number, height: number): Int32Array {
  const nearest = new Int32Array(width * height).fill(-1);
  const count = directions.length / 3;
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      const d = fromMap((4 * (column + 0.5)) / width - 2, 1 - (2 * (row + 0.5)) / height);
      if (!d) continue;
      let best = -2;
      for (let i = 0; i < count; ++i) {
        const dot = d[0] * directions[3 * i] + d[1] * directions[3 * i + 1] + d[2] * directions[3 * i + 2];
        if (dot > best) {
          best = dot;
          nearest[row * width + column] = i;
        }
      }
    }
  }
  return nearest;
}
