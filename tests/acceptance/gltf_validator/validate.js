// Validates every glTF file that standard input names, a line each, and prints what Khronos' validator finds as a line of JSON.
import fs from 'node:fs';
import path from 'node:path';
import readline from 'node:readline';
import validator from 'gltf-validator';

const resource = (file) => async (uri) => new Uint8Array(fs.readFileSync(path.resolve(path.dirname(file), decodeURIComponent(uri))));

for await (const file of readline.createInterface({ input: process.stdin })) {
  let row;
  try {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
      uri: path.basename(file), format: file.endsWith('.glb') ? 'glb' : 'gltf', maxIssues: 0, writeTimestamp: false,
      externalResourceFunction: resource(file) });
    row = { file, errors: report.issues.messages.filter((m) => m.severity === 0) };
  } catch (problem) {
    row = { file, errors: [], failed: String(problem).slice(0, 200) };  // its own limits: a stack overflow, an assertion
  }
  console.log(JSON.stringify(row));
}
