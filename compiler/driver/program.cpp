// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace robdef {

namespace {

std::string shell_word(std::string_view word) {
  std::string text = "'";
  for (const char letter : word) {
    text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  }
  return text + "'";
}

int open_for_writing(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) throw std::system_error(errno, std::generic_category(), path.string());
  return file;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "robdef-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryFolder::operator/(std::string_view name) const {
  return (path_ / name).string();
}

std::string TemporaryFolder::write(std::string_view name, std::string_view text) const {
  const std::filesystem::path file = path_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

std::vector<std::string> TemporaryFolder::files() const {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) {
    if (entry.is_regular_file()) {
      found.push_back(entry.path().lexically_relative(path_).generic_string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

Ended run_robdef(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
                 const std::string& import_variable, const std::string& input) {
  const TemporaryFolder output;
  std::string command = "cd " + shell_word(folder.path().string()) +
                        " && ROBOTRACONTEUR_ROBDEF_PATH=" + shell_word(import_variable) + " " +
                        shell_word(ROBDEF_PROGRAM);
  for (const std::string& argument : arguments) command += " " + shell_word(argument);
  command += " <" + shell_word(output.write("in", input));
  command += " >" + shell_word(output / "out") + " 2>" + shell_word(output / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(output / "out"),
          read_text(output / "err")};
}

Running::Running(const TemporaryFolder& folder, std::vector<std::string> arguments)
    : out_(folder / "running.out"), err_(folder / "running.err") {
  arguments.insert(arguments.begin(), ROBDEF_PROGRAM);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  const int out = open_for_writing(out_);
  const int err = open_for_writing(err_);
  process_ = ::fork();
  if (process_ != 0) {
    ::close(out);
    ::close(err);
    return;
  }
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  if (::chdir(folder.path().c_str()) == 0) ::execv(words[0], words.data());
  ::_exit(127);
}

Running::~Running() {
  if (process_ > 0) end();
}

std::uint16_t Running::port() const {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  std::string text = out();
  while (text.find('\n') == std::string::npos && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    text = out();
  }
  const std::string line = text.substr(0, text.find('\n'));
  return static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(' ') + 1)));
}

int Running::end(int signal) {
  if (signal != 0) ::kill(process_, signal);
  int status = 0;
  ::waitpid(std::exchange(process_, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace robdef
