// SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Sphere, Vector3 } from 'three';
import type { SacBox } from './decoder.js';
import type { RenderMesh } from './geometry.js';

/** The geometry of a mesh whose shapes come later; with a second shape to go to where it `interpolates`. */
export function makeGeometry(mesh: RenderMesh, interpolates: boolean): BufferGeometry {
  const geometry = new BufferGeometry(), n = mesh.vertices;
  geometry.setIndex(new BufferAttribute(mesh.index, 1));
  const add = (name: string, attribute: BufferAttribute) => geometry.setAttribute(name, attribute);
  for (const [position, normal] of [['position', 'normal'], ['sacNextPosition', 'sacNextNormal']] as const) {
    add(position, new BufferAttribute(new Float32Array(3 * n), 3).setUsage(DynamicDrawUsage));
    add(normal, new BufferAttribute(new Int16Array(4 * n), 4, true).setUsage(DynamicDrawUsage));
    if (!interpolates) break;
  }
  if (mesh.uvs) add('uv', new BufferAttribute(mesh.uvs, 2));
  if (mesh.colors) add('color', new BufferAttribute(mesh.colors, 4, true));
  geometry.boundingSphere = new Sphere();
  geometry.boundingBox = new Box3();
  return geometry;
}

/** Has an attribute show another array of the same length. */
export function upload(attribute: BufferAttribute, array: BufferAttribute['array']): void {
  attribute.array = array;
  attribute.needsUpdate = true;
}

const corner = new Vector3();

/** Sets the bounds to those of boxes. */
export function setBounds(geometry: BufferGeometry, ...boxes: SacBox[]): void {
  const box = geometry.boundingBox!.makeEmpty();
  for (const { low, high } of boxes) box.expandByPoint(corner.set(...low)).expandByPoint(corner.set(...high));
  box.getBoundingSphere(geometry.boundingSphere!);
}
