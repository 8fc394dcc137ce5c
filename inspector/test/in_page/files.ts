// SPDX-License-Identifier: Apache-2.0
// `node:fs` and `node:path` in a page: files that the driver has put there.
declare global {
  /** Texts of files. */
  var pageFiles: Map<string, string>;
}

export function join(...parts: string[]): string {
  return parts.join("/");
}

export function readFileSync(path: string): string {
  const text = pageFiles.get(path);
  if (text === undefined) throw new Error(`the page has no file ${path}`);
  return text;
}

export function readdirSync(folder: string): string[] {
  return [...pageFiles.keys()].filter((path) => path.startsWith(`${folder}/`)).map((path) => path.slice(folder.length + 1));
}
