// SPDX-License-Identifier: Apache-2.0
'use strict';
const { workspace } = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');

let client;

exports.activate = () => {
  const settings = workspace.getConfiguration('robdef');
  const folders = settings.get('importFolders', []).flatMap((folder) => ['-I', folder]);
  const server = { command: settings.get('program', 'robdef'), args: ['lsp', ...folders] };
  client = new LanguageClient('robdef', 'Robdef', server, { documentSelector: [{ language: 'robdef' }] });
  return client.start();
};

exports.deactivate = () => client?.stop();
