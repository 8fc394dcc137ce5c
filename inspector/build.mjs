// SPDX-License-Identifier: Apache-2.0
// node build.mjs [page|tests]: makes dist/inspector.html, one file with everything in it, or the tests in dist-test.
import { createHash } from "node:crypto";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import * as esbuild from "esbuild";

const mostGzipped = 500 * 1000;
const runtime = new URL("../runtime/typescript/src/", import.meta.url).pathname;
const alias = {
  "@robdef/runtime/messages": `${runtime}messages.ts`,
  "@robdef/runtime/node": `${runtime}index.node.ts`,
  "@robdef/runtime": `${runtime}index.ts`,
};
const shared = { bundle: true, alias, target: "es2022", logLevel: "warning", legalComments: "none" };
const forPage = { ...shared, minify: true, write: false, jsx: "automatic", jsxImportSource: "preact" };

async function script(entry, more) {
  const made = await esbuild.build({ ...forPage, entryPoints: [entry], format: "iife", ...more });
  const text = made.outputFiles[0].text.trim();
  if (/<\/script|<!--/i.test(text)) throw new Error(`${entry} has what would end a script of HTML`);
  return text;
}

const hashOf = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

async function page() {
  const [main, scene, style] = await Promise.all([
    script("src/main.tsx"),
    script("src/scene/scene.ts", { globalName: "robdefScene" }),
    esbuild.build({ ...forPage, entryPoints: ["src/style.css"] }).then((made) => made.outputFiles[0].text.trim()),
  ]);
  // Only these scripts and this style run, whatever else gets into the page. Web sockets go anywhere: devices do.
  // http is for the look whether anything answers at a port.
  const policy = [
    "default-src 'none'",
    `script-src ${hashOf(main)} ${hashOf(scene)}`,
    `style-src ${hashOf(style)}`,
    "connect-src ws: wss: http: https:",
    "worker-src blob:",
    "img-src data: blob:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");
  const parts = { "@POLICY@": policy, "@STYLE@": style, "@SCENE@": scene, "@SCRIPT@": main };
  const html = readFileSync("src/page.html", "utf8").replace(/@[A-Z]+@/g, (name) => parts[name] ?? name);
  mkdirSync("dist", { recursive: true });
  writeFileSync("dist/inspector.html", html);
  // As nodes serve it.
  const compressed = gzipSync(html, { level: 9 });
  writeFileSync("dist/inspector.html.gz", compressed);
  const size = compressed.length;
  const kilobytes = (bytes) => `${(bytes / 1000).toFixed(1)} kB`;
  console.log(`dist/inspector.html: ${kilobytes(html.length)}, ${kilobytes(size)} gzipped (3-D ${kilobytes(gzipSync(scene).length)}, the rest ${kilobytes(gzipSync(main + style).length)})`);
  if (size > mostGzipped) throw new Error(`${size} bytes gzipped are more than ${mostGzipped}`);
}

async function tests() {
  const entries = readdirSync("test").filter((name) => /\.(?:test|browser|main)\.tsx?$/.test(name)).map((name) => `test/${name}`);
  await esbuild.build({ ...shared, entryPoints: entries, outdir: "dist-test", platform: "node", format: "esm", outExtension: { ".js": ".mjs" }, sourcemap: "inline", jsx: "automatic", jsxImportSource: "preact", external: ["axe-core"] });
  // Tests of the codec, for a page: what they use of Node is replaced.
  const inPage = (name) => new URL(`test/in_page/${name}.ts`, import.meta.url).pathname;
  await esbuild.build({
    ...shared,
    entryPoints: ["captures", "codec", "values"].map((name) => ({ in: `../runtime/typescript/test/${name}.test.ts`, out: name })),
    outdir: "dist-test/in_page",
    platform: "browser",
    format: "iife",
    nodePaths: ["node_modules"],
    inject: [inPage("globals")],
    alias: { ...alias, "node:test": inPage("node_test"), "node:assert/strict": inPage("assert"), "node:fs": inPage("files"), "node:path": inPage("files") },
  });
}

await (process.argv[2] === "tests" ? tests() : page());
