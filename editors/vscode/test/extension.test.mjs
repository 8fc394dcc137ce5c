// SPDX-License-Identifier: Apache-2.0
// The files of the extension are well-formed, name each other, and know the words of the language.
import assert from 'node:assert';
import { existsSync, readFileSync } from 'node:fs';
import { test } from 'node:test';

const folder = new URL('..', import.meta.url);
const text = (name) => readFileSync(new URL(name, folder), 'utf8');
const json = (name) => JSON.parse(text(name));
const tree = (name) => text(`../../${name}`);

// The words of a table of the compiler: those in quotes between two marks.
function words(source, begin, end) {
  const from = source.indexOf(begin);
  assert.notEqual(from, -1, begin);
  return [...source.slice(from, source.indexOf(end, from)).matchAll(/WordHelp\{"([a-z0-9]+)"/g)].map((found) => found[1]);
}

function alternatives(scope) {
  const rule = json('syntaxes/robdef.tmLanguage.json').patterns.find((one) => one.name === scope);
  return rule.match.match(/\(\?:([a-z0-9|]+)\)/)[1].split('|');
}

test('the package names files that are there', () => {
  const { contributes, main } = json('package.json');
  for (const path of [main, contributes.languages[0].configuration, contributes.grammars[0].path]) {
    assert.ok(existsSync(new URL(path, folder)), path);
  }
  assert.deepEqual(contributes.languages[0].extensions, ['.robdef']);
  assert.equal(json(contributes.grammars[0].path).scopeName, contributes.grammars[0].scopeName);
});

test('the words of the grammar are those of the language', () => {
  const source = tree('compiler/lsp/words.cpp');
  const sorted = (list) => [...list].sort();
  assert.deepEqual(sorted(alternatives('keyword.control.robdef')), sorted([...words(source, 'keywords = {', '};'), 'as']));
  assert.deepEqual(sorted(alternatives('support.type.robdef')), sorted(words(source, 'types = {', '};')));
  assert.deepEqual(sorted(alternatives('storage.modifier.robdef')), sorted(words(source, 'modifiers = {', '};')));
});

test('its expressions are expressions', () => {
  for (const rule of json('syntaxes/robdef.tmLanguage.json').patterns) {
    for (const expression of [rule.match, rule.begin, rule.end]) new RegExp(expression ?? '');
  }
  const rules = json('language-configuration.json').indentationRules;
  assert.match('  struct A', new RegExp(rules.increaseIndentPattern));
  assert.doesNotMatch('  property double a', new RegExp(rules.increaseIndentPattern));
  assert.match('  end', new RegExp(rules.decreaseIndentPattern));
});

test('the client starts the server', () => {
  const source = text('extension.js');
  assert.match(source, /args: \['lsp', /);
  new Function('require', 'exports', source);
});
