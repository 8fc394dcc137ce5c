// SPDX-License-Identifier: Apache-2.0
#include "cli/live/line_editor.hpp"

#include <dlfcn.h>
#include <histedit.h>

#include <clocale>
#include <cstdio>
#include <iostream>
#include <string_view>
#include <utility>

#include "cli/live/complete.hpp"
#include "cli/live/line_words.hpp"

namespace robdef::live {
namespace {

// libedit, loaded when it is needed: a program that generates code should not wait for it. It stays
// loaded, since it keeps memory from the first line on.
class Library {
 public:
  Library() : handle_(::dlopen("libedit.so.2", RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) return;
    is_complete_ = load(init, "el_init") && load(set, "el_set") && load(gets, "el_gets") &&
                   load(end, "el_end") && load(line, "el_line") && load(insert, "el_insertstr") &&
                   load(history_init, "history_init") && load(history_do, "history") &&
                   load(history_end, "history_end");
  }
  [[nodiscard]] bool is_there() const { return is_complete_; }

  decltype(&::el_init) init = nullptr;
  decltype(&::el_set) set = nullptr;
  decltype(&::el_gets) gets = nullptr;
  decltype(&::el_end) end = nullptr;
  decltype(&::el_line) line = nullptr;
  decltype(&::el_insertstr) insert = nullptr;
  decltype(&::history_init) history_init = nullptr;
  decltype(&::history) history_do = nullptr;
  decltype(&::history_end) history_end = nullptr;

 private:
  template <class Pointer>
  bool load(Pointer& pointer, const char* name) {
    pointer = reinterpret_cast<Pointer>(::dlsym(handle_, name));
    return pointer != nullptr;
  }

  void* handle_;
  bool is_complete_ = false;
};

class Editor final : public LineReader {
 public:
  Editor(std::unique_ptr<Library> library, Completer completer)
      : library_(std::move(library)), completer_(std::move(completer)) {
    std::setlocale(LC_CTYPE, "");
    editor_ = library_->init("robdef", stdin, stdout, stderr);
    history_ = library_->history_init();
    HistEvent event{};
    library_->history_do(history_, &event, H_SETSIZE, 1000);
    library_->set(editor_, EL_PROMPT, &Editor::prompt);
    library_->set(editor_, EL_EDITOR, "emacs");
    library_->set(editor_, EL_SIGNAL, 1);
    library_->set(editor_, EL_HIST, library_->history_do, history_);
    library_->set(editor_, EL_ADDFN, "complete-member", "completes members",
                  &Editor::complete_word);
    library_->set(editor_, EL_BIND, "^I", "complete-member", nullptr);
    self_ = this;
  }
  ~Editor() override {
    self_ = nullptr;
    library_->history_end(history_);
    library_->end(editor_);
  }
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;

  std::optional<std::string> read(const std::string& prompt) override {
    prompt_ = prompt;
    int length = 0;
    const char* const text = library_->gets(editor_, &length);
    if (text == nullptr || length <= 0) return std::nullopt;
    std::string line(text, static_cast<std::size_t>(length));
    if (line.ends_with('\n')) line.pop_back();
    HistEvent event{};
    if (!line.empty()) library_->history_do(history_, &event, H_ENTER, line.c_str());
    return line;
  }
  [[nodiscard]] bool is_terminal() const override { return true; }

 private:
  static char* prompt(EditLine*) { return self_->prompt_.data(); }
  static unsigned char complete_word(EditLine*, int) { return self_->complete(); }

  unsigned char complete() {
    const LineInfo* const info = library_->line(editor_);
    const std::string before(info->buffer, info->cursor);
    const std::vector<std::string> found = completer_(before);
    if (found.empty()) return CC_REFRESH_BEEP;
    const LineWords words = split_line(before);
    const std::string common = common_beginning(found);
    std::string added = common.substr(words.is_last_open ? words.words.back().size() : 0);
    if (found.size() == 1 && !common.ends_with('.') && !common.ends_with('[')) added += ' ';
    if (!added.empty()) {
      library_->insert(editor_, added.c_str());
      return CC_REFRESH;
    }
    std::cout << '\n';
    for (const std::string& word : found) std::cout << word << '\n';
    std::cout << std::flush;
    return CC_REDISPLAY;
  }

  // libedit's functions are given nothing else; there is one terminal.
  static inline Editor* self_ = nullptr;
  std::unique_ptr<Library> library_;
  Completer completer_;
  std::string prompt_;
  EditLine* editor_ = nullptr;
  History* history_ = nullptr;
};

}  // namespace

std::unique_ptr<LineReader> make_line_editor(Completer completer) {
  auto library = std::make_unique<Library>();
  if (!library->is_there()) return nullptr;
  return std::make_unique<Editor>(std::move(library), std::move(completer));
}

}  // namespace robdef::live
