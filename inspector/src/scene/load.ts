// SPDX-License-Identifier: Apache-2.0
import type { Scene } from "./scene.js";

type MakeScene = (place: HTMLElement) => Scene;

let loading: Promise<MakeScene> | undefined;

/**
 * Runs the script of the file that draws in 3-D: it is there as a text, so that pages without 3-D need not read it. The
 * content security policy knows its hash.
 */
export function loadScene(): Promise<MakeScene> {
  loading ??= new Promise((resolve, reject) => {
    const text = document.getElementById("scene-script")?.textContent;
    if (!text) {
      reject(new Error("this build of the inspector has no 3-D"));
      return;
    }
    const script = document.createElement("script");
    script.textContent = text;
    document.head.append(script);
    const { robdefScene } = globalThis as { robdefScene?: { makeScene: MakeScene } };
    if (robdefScene) resolve(robdefScene.makeScene);
    else reject(new Error("the script for 3-D did not run"));
  });
  return loading;
}
