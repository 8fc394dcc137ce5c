-- SPDX-License-Identifier: Apache-2.0
-- A session in Neovim: completion, a quick fix, a rename over two files, the layout. Leaves the
-- buffers in the files `<name>.after`; ends with status 1 where something does not come.
local root, set_up = vim.env.ROBDEF_SESSION, vim.env.ROBDEF_NEOVIM
vim.g.robdef_program = vim.env.ROBDEF_PROGRAM
dofile(set_up)

local function fail(what)
  io.stderr:write(what .. '\n')
  vim.cmd('cquit 1')
end
local function wait(what, condition)
  if not vim.wait(20000, condition, 5) then fail('never came: ' .. what) end
end
local function request(method, params)
  local all, err = vim.lsp.buf_request_sync(0, method, params, 20000)
  if not all then fail(method .. ': ' .. tostring(err)) end
  for _, answer in pairs(all) do
    if answer.err then fail(method .. ': ' .. vim.inspect(answer.err)) end
    return answer.result
  end
  fail(method .. ': no answer')
end
local function place(line, column) vim.api.nvim_win_set_cursor(0, { line, column }) end
local function client() return vim.lsp.get_active_clients()[1] end
local function apply(edit) vim.lsp.util.apply_workspace_edit(edit, client().offset_encoding) end

vim.cmd('edit ' .. root .. '/example.geometry.robdef')
vim.cmd('edit ' .. root .. '/example.arm.robdef')
wait('the server', function() return client() and client().initialized end)
-- Diagnostics of a misspelt type, and the quick fix of it.
wait('a diagnostic', function() return #vim.diagnostic.get(0) == 1 end)
local found = vim.diagnostic.get(0)[1]
if found.lnum ~= 4 or found.col ~= 30 then fail('the diagnostic is elsewhere') end
place(5, 31)
local fix = vim.lsp.util.make_range_params()
fix.context = { diagnostics = {} }
apply(request('textDocument/codeAction', fix)[1].edit)
wait('no diagnostic', function() return #vim.diagnostic.get(0) == 0 end)

-- A line with the words that completion offers.
vim.api.nvim_buf_set_lines(0, 5, 5, true, { '    property dou' })
place(6, 15)
vim.cmd('startinsert!')
local items = request('textDocument/completion', { textDocument = vim.lsp.util.make_text_document_params(), position = { line = 5, character = 16 } }).items
local taken = vim.tbl_filter(function(item) return item.label == 'double' end, items)[1]
vim.lsp.util.apply_text_edits({ taken.textEdit }, 0, client().offset_encoding)
vim.api.nvim_buf_set_lines(0, 5, 6, true, { vim.api.nvim_buf_get_lines(0, 5, 6, true)[1] .. ' speed   [readonly]' })

-- A rename in both files, asked for where the type is used.
place(5, 31)
local rename = vim.lsp.util.make_position_params()
rename.newName = 'Position'
apply(request('textDocument/rename', rename))

-- The layout.
local format = vim.lsp.util.make_formatting_params({})
vim.lsp.util.apply_text_edits(request('textDocument/formatting', format), 0, client().offset_encoding)
wait('no diagnostic', function() return #vim.diagnostic.get(0) == 0 end)

for _, buffer in ipairs(vim.api.nvim_list_bufs()) do
  local name = vim.api.nvim_buf_get_name(buffer)
  if name:match('%.robdef$') then
    vim.fn.writefile(vim.api.nvim_buf_get_lines(buffer, 0, -1, true), name .. '.after')
  end
end
vim.lsp.stop_client(vim.lsp.get_active_clients())
wait('the end of the server', function() return #vim.lsp.get_active_clients() == 0 end)
vim.cmd('qall!')
