// SPDX-License-Identifier: Apache-2.0
import { fileURLToPath } from "node:url";
import tseslint from "typescript-eslint";

export default tseslint.config(
  { ignores: ["dist/", "dist-test/", "dist-generated/", "package_test/"] },
  ...tseslint.configs.strictTypeChecked,
  {
    files: ["src/**/*.ts", "test/**/*.ts"],
    languageOptions: {
      parserOptions: { project: "./tsconfig.test.json", tsconfigRootDir: fileURLToPath(new URL(".", import.meta.url)) },
    },
  },
  {
    files: ["src/**/*.ts", "test/**/*.ts", "generated/**/*.test.ts"],
    rules: {
      // Numbers in texts are what messages are about.
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true, allowBoolean: true }],
      // Values are generic in what the caller says they are.
      "@typescript-eslint/no-unnecessary-type-parameters": "off",
      // What an unknown value looks like is asked for in messages only.
      "@typescript-eslint/no-base-to-string": "off",
      // The reason of a signal is what its owner says.
      "@typescript-eslint/prefer-promise-reject-errors": "off",
      "@typescript-eslint/no-unused-vars": ["error", { varsIgnorePattern: "^_", argsIgnorePattern: "^_" }],
      // Values from messages have the type that their definition says.
      "@typescript-eslint/no-unsafe-class-instance-assignment": "off",
    },
  },
  {
    files: ["generated/**/*.ts"],
    languageOptions: {
      parserOptions: { project: "./tsconfig.generated.json", tsconfigRootDir: fileURLToPath(new URL(".", import.meta.url)) },
    },
  },
  {
    files: ["test/**/*.ts", "generated/**/*.test.ts"],
    rules: {
      // node:test reports what its functions return by itself.
      "@typescript-eslint/no-floating-promises": ["error", { allowForKnownSafeCalls: [{ from: "package", name: ["test", "describe", "it"], package: "node:test" }] }],
      "@typescript-eslint/require-await": "off",
      "@typescript-eslint/no-non-null-assertion": "off",
    },
  },
  { files: ["eslint.config.js"], ...tseslint.configs.disableTypeChecked },
);
