/** How light voxels are: shared by their faces and their points. */
import type { Rgb } from "../model/colors.ts";

/** Colour of a voxel, 0 to 255 per channel, and its own shading where the surface's normal is known. */
export type VoxelColor = (voxel: number) => { rgb: Rgb; shade: number | null };

/** How light a face is: as if the sun stood to the upper left in front. */
export const SHADE = [0.74, 0.86, 0.9, 0.7, 0.6, 1];

/** How much light reaches a corner, by how many of the three cells before it are free. */
export const NOOK = [0.7, 0.82, 0.92, 1];

/** Where the surface's normal is known its shading counts, so that curved surfaces look curved. */
export const lightOf = (shade: number | null, side: number) => (shade === null ? side : 0.75 * shade + 0.25 * side);

/** A channel, 0 to 255, in that light: beyond 1 it goes towards white, as where the sun shines on it. */
export const lit = (channel: number, light: number) =>
  light <= 1 ? channel * light : channel + (255 - channel) * (light - 1);

/** Light on a surface with this unit normal: never dark, brightest where it looks at the sun. */
export function sunlight(nx: number, ny: number, nz: number): number {
  const towards = -0.35 * nx - 0.55 * ny + 0.75 * nz;
  return 0.6 + 0.4 * (0.5 + 0.5 * towards) + 0.34 * Math.max(0, towards) ** 3;
}
