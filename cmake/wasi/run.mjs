// SPDX-License-Identifier: Apache-2.0
// Runs a program of WebAssembly: node run.mjs PROGRAM STANDARD_INPUT
import { openSync, readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const [program, input] = process.argv.slice(2);
const wasi = new WASI({ version: "preview1", args: [program], stdin: openSync(input, "r"), returnOnExit: true });
const { instance } = await WebAssembly.instantiate(readFileSync(program), wasi.getImportObject());
process.exitCode = wasi.start(instance);
