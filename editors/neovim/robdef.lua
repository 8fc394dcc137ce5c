-- SPDX-License-Identifier: Apache-2.0
-- Service definitions in Neovim 0.7 and later: dofile('/path/to/robdef.lua') in init.lua.
local function filetype(name)
  vim.bo.filetype = 'robdef'
  vim.bo.commentstring = '# %s'
  local project = vim.fs and vim.fs.find('robdef.toml', { upward = true, path = vim.fn.fnamemodify(name, ':h') })[1]
  local client = {
    name = 'robdef',
    cmd = { vim.g.robdef_program or 'robdef', 'lsp' },
    root_dir = vim.fn.fnamemodify(project or name, ':p:h'),
    on_attach = function(_, buffer)
      vim.api.nvim_buf_set_option(buffer, 'omnifunc', 'v:lua.vim.lsp.omnifunc')
    end,
  }
  if vim.lsp.start then
    return vim.lsp.start(client)
  end
  -- Neovim 0.7: one client for each folder.
  _G.robdef_clients = _G.robdef_clients or {}
  local known = _G.robdef_clients[client.root_dir]
  if not known or not vim.lsp.get_client_by_id(known) then
    known = vim.lsp.start_client(client)
    _G.robdef_clients[client.root_dir] = known
  end
  vim.lsp.buf_attach_client(0, known)
end

vim.api.nvim_create_autocmd({ 'BufRead', 'BufNewFile' }, {
  pattern = '*.robdef',
  callback = function(event) filetype(event.match) end,
})
