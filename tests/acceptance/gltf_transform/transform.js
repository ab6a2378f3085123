// For every line of standard input, {"file", "out"?}: reads the file with glTF-Transform and prints what it holds as a line of JSON. With
// `out` its specular-glossiness materials become metallic-roughness by its own function, and the result is written there.
import readline from 'node:readline';
import { Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { metalRough } from '@gltf-transform/functions';

const io = new NodeIO().setLogger(new Logger(Logger.Verbosity.SILENT)).registerExtensions(ALL_EXTENSIONS);

for await (const line of readline.createInterface({ input: process.stdin })) {
  const { file, out } = JSON.parse(line);
  let row;
  try {
    const document = await io.read(file), root = document.getRoot();
    if (out) await document.transform(metalRough());
    if (out) await io.write(out, document);
    row = { file, materials: root.listMaterials().length, meshes: root.listMeshes().length,
      lights: root.listExtensionsUsed().some((e) => e.extensionName === 'KHR_lights_punctual'),
      pictures: root.listTextures().map((t) => t.getSize()) };
  } catch (problem) {
    row = { file, failed: String(problem).slice(0, 300) };
  }
  console.log(JSON.stringify(row));
}
