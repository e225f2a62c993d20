// SPDX-License-Identifier: Apache-2.0
// Checks glTF files by Khronos' own validator.
// usage: node validate_gltf.mjs FILE...
// Exit code 1 if there is an error or a warning.
import fs from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';

for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    externalResourceFunction: async (uri) =>
      new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings`);
  for (const { severity, code, message, pointer } of messages) {
    if (severity < 2) console.error(`  ${code} ${pointer}: ${message}`);
  }
  if (numErrors + numWarnings > 0) process.exitCode = 1;
}
