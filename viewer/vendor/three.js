// SPDX-License-Identifier: BSD-3-Clause
// What the live page uses of three.js; tools/vendor_page bundles it into viewer/page/vendor/three.js.
export {
  AlwaysDepth, BackSide, Box3, BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, Color, CylinderGeometry,
  DataTexture, DirectionalLight, DoubleSide, DynamicDrawUsage, FloatType, Group, InstancedBufferAttribute,
  InstancedMesh, LinearFilter, LinearMipmapLinearFilter, Line, LineBasicMaterial, LineSegments, Matrix3, Matrix4, Mesh,
  MeshBasicMaterial, NearestFilter, NoToneMapping, Object3D, OrthographicCamera, PCFShadowMap, PerspectiveCamera, Plane,
  PlaneGeometry, Points, Quaternion, RGBAFormat, Ray, Raycaster, RepeatWrapping, SRGBColorSpace, Scene, ShaderMaterial,
  Sphere, SphereGeometry, Texture, UniformsLib, UniformsUtils, Vector2, Vector3, Vector4, WebGLRenderTarget,
  WebGLRenderer,
} from 'three';
export {OrbitControls} from 'three/addons/controls/OrbitControls.js';
