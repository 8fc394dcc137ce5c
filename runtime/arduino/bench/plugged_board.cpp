// SPDX-License-Identifier: Apache-2.0
#include "runtime/arduino/bench/plugged_board.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace rr::serial::testing {

using namespace std::chrono_literals;

struct PluggedBoard::Terminal {
  Terminal() : master(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) {
      throw std::runtime_error("no pseudo terminal");
    }
    name = ::ptsname(master);
    // Kept open, so that hosts may come and go; raw, before anything is sent.
    slave = ::open(name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    ::tcgetattr(slave, &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(slave, TCSANOW, &settings);
  }
  ~Terminal() {
    ::close(slave);
    ::close(master);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  int master;
  int slave = -1;
  std::string name;
};

PluggedBoard::PluggedBoard(const std::string& elf, std::uint32_t baud) : baud_(baud) {
  std::string folder = (std::filesystem::temp_directory_path() / "robdef_board_XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no folder for a port");
  folder_ = folder;
  path_ = folder_ + "/port";
  plug(elf);
  thread_ = std::thread([this] { run(); });
}

PluggedBoard::~PluggedBoard() {
  stops_ = true;
  thread_.join();
  std::filesystem::remove_all(folder_);
}

void PluggedBoard::unplug() {
  const std::lock_guard lock(mutex_);
  std::filesystem::remove(path_);
  terminal_.reset();
}

void PluggedBoard::plug() {
  const std::lock_guard lock(mutex_);
  board_->reset();
  (void)board_->receive();
  terminal_ = std::make_unique<Terminal>();
  std::filesystem::create_symlink(terminal_->name, path_);
}

void PluggedBoard::plug(const std::string& elf) {
  {
    const std::lock_guard lock(mutex_);
    board_ = std::make_unique<SimulatedBoard>(elf, baud_);
  }
  plug();
}

void PluggedBoard::set_voltage(double volts) {
  const std::lock_guard lock(mutex_);
  board_->set_voltage(0, volts);
}

std::uint8_t PluggedBoard::peek(std::uint16_t address) {
  const std::lock_guard lock(mutex_);
  return board_->peek(address);
}

void PluggedBoard::run() {
  const auto begun = std::chrono::steady_clock::now();
  SimulatedBoard::Time paused{};
  while (!stops_) {
    SimulatedBoard::Time ahead{};
    {
      const std::lock_guard lock(mutex_);
      if (resets_.exchange(false)) board_->reset();
      exchange();
      board_->run_until(board_->now() + 500us);
      const auto real = std::chrono::duration_cast<SimulatedBoard::Time>(
          std::chrono::steady_clock::now() - begun);
      ahead = board_->now() + paused - real;
    }
    // Not ahead of the time, or the processor would never have to wait; what was missed is not
    // caught up with.
    if (ahead > 1ms) std::this_thread::sleep_for(ahead);
    if (ahead < -20ms) paused -= ahead;
  }
}

void PluggedBoard::exchange() {
  const std::vector<std::uint8_t> out = board_->receive();
  if (!terminal_) return;
  std::vector<std::uint8_t> bytes(256);
  const ssize_t got = ::read(terminal_->master, bytes.data(), bytes.size());
  if (got > 0 && !is_silent_) {
    bytes.resize(static_cast<std::size_t>(got));
    board_->send(bytes);
  }
  if (!out.empty() && !is_silent_) (void)!::write(terminal_->master, out.data(), out.size());
}

}  // namespace rr::serial::testing
