// SPDX-License-Identifier: Apache-2.0
import type { Material, WebGLProgramParametersWithUniforms } from 'three';

/** What the patched shaders of a mesh read. */
export interface BlendUniforms {
  /** How far the time is from the shape that is shown to the next, 0 to 1. */
  sacMix: { value: number };
}

const patched = new WeakMap<Material, BlendUniforms>();

const declarations = `
attribute vec3 sacNextPosition;
attribute vec4 sacNextNormal;
uniform float sacMix;
`;

/**
 * Has a material of three.js blend each vertex of a SacMesh between two shapes. Materials that are already another
 * mesh's are cloned, because what their shaders read belongs to one mesh.
 */
export function blendMaterial<M extends Material>(material: M, uniforms: BlendUniforms): M {
  const owner = patched.get(material);
  if (owner === uniforms) return material;
  const own = owner ? (material.clone() as M) : material;
  const before = own.onBeforeCompile, key = own.customProgramCacheKey;
  own.onBeforeCompile = function (shader: WebGLProgramParametersWithUniforms, renderer) {
    before.call(this, shader, renderer);
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = declarations + shader.vertexShader
      .replace('#include <beginnormal_vertex>',
        '#include <beginnormal_vertex>\nobjectNormal = normalize(mix(objectNormal, sacNextNormal.xyz, sacMix) + vec3(1e-20));')
      .replace('#include <begin_vertex>',
        '#include <begin_vertex>\ntransformed = mix(transformed, sacNextPosition, sacMix);');
  };
  own.customProgramCacheKey = function () {
    return `${key.call(this)} sac-mix`;
  };
  own.needsUpdate = true;
  patched.set(own, uniforms);
  return own;
}
