// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/shared_memory.hpp"

#include <fcntl.h>
#include <linux/futex.h>
#include <linux/magic.h>
#include <linux/sockios.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstring>
#include <ctime>

#include "runtime/cpp/src/platform/linux/system_calls.hpp"

namespace rr::platform {
namespace {

constexpr int size_seals = F_SEAL_SHRINK | F_SEAL_GROW;
// Mappings that exist stay writable, and there are no others. Linux has it since 5.1; before that,
// sealing fails.
constexpr int reading_seals = size_seals | F_SEAL_FUTURE_WRITE;

SharedMemory map(int handle, std::size_t size, int protection, std::error_code& error) {
  void* const bytes = ::mmap(nullptr, size, protection, MAP_SHARED, handle, 0);
  if (bytes == MAP_FAILED) {
    error = last_error();
    return {};
  }
  return {static_cast<std::byte*>(bytes), size};
}

// A file of another kind may block whoever looks at a page, or have none to give.
bool is_sealed_memory(int handle, int wanted) {
  const int seals = ::fcntl(handle, F_GET_SEALS);
  struct statfs system {};
  return seals != -1 && (seals & wanted) == wanted && ::fstatfs(handle, &system) == 0 &&
         static_cast<unsigned long>(system.f_type) == TMPFS_MAGIC;
}

SharedMemory make(std::size_t size, int seals, Descriptor& handle, std::error_code& error) {
  Descriptor made(::memfd_create("robdef", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!made || ::ftruncate(made.get(), static_cast<off_t>(size)) != 0) {
    error = last_error();
    return {};
  }
  SharedMemory memory = map(made.get(), size, PROT_READ | PROT_WRITE, error);
  if (!memory) return {};
  if (::fcntl(made.get(), F_ADD_SEALS, seals | F_SEAL_SEAL) != 0) {
    error = last_error();
    return {};
  }
  handle = std::move(made);
  return memory;
}

SharedMemory map_received(const Descriptor& handle, std::size_t largest, int seals, int protection,
                          std::error_code& error) {
  struct stat file {};
  if (!handle || !is_sealed_memory(handle.get(), seals) || ::fstat(handle.get(), &file) != 0 ||
      file.st_size <= 0 || static_cast<std::uintmax_t>(file.st_size) > largest) {
    error = std::make_error_code(std::errc::invalid_argument);
    return {};
  }
  return map(handle.get(), static_cast<std::size_t>(file.st_size), protection, error);
}

// Room for what passes handles along with bytes.
struct alignas(cmsghdr) HandleRoom {
  std::array<std::byte, CMSG_SPACE(sizeof(int))> bytes{};
};

// Keeps the first of the handles that have come, and closes the others.
void take_handles(msghdr& message, Descriptor& handle) {
  for (cmsghdr* item = CMSG_FIRSTHDR(&message); item != nullptr;
       item = CMSG_NXTHDR(&message, item)) {
    if (item->cmsg_level != SOL_SOCKET || item->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (item->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(item) + i * sizeof number, sizeof number);
      Descriptor come(number);
      if (!handle) handle = std::move(come);
    }
  }
}

msghdr message_of(iovec& piece, HandleRoom& room) {
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = room.bytes.data();
  message.msg_controllen = room.bytes.size();
  return message;
}

}  // namespace

bool has_shared_memory() { return true; }

SharedMemory::~SharedMemory() {
  if (bytes_ != nullptr) ::munmap(bytes_, size_);
}

SharedMemory make_shared_memory(std::size_t size, Descriptor& handle, std::error_code& error) {
  return make(size, size_seals, handle, error);
}

SharedMemory map_shared_memory(const Descriptor& handle, std::size_t largest,
                               std::error_code& error) {
  return map_received(handle, largest, size_seals, PROT_READ | PROT_WRITE, error);
}

SharedMemory make_published_memory(std::size_t size, Descriptor& handle, std::error_code& error) {
  return make(size, reading_seals, handle, error);
}

SharedMemory map_published_memory(const Descriptor& handle, std::size_t largest,
                                  std::error_code& error) {
  return map_received(handle, largest, reading_seals, PROT_READ, error);
}

std::ptrdiff_t send_with_handle(int socket, std::span<const std::byte> bytes,
                                const Descriptor& handle) {
  iovec piece{const_cast<std::byte*>(bytes.data()), bytes.size()};
  HandleRoom room;
  msghdr message = message_of(piece, room);
  cmsghdr* const item = CMSG_FIRSTHDR(&message);
  item->cmsg_level = SOL_SOCKET;
  item->cmsg_type = SCM_RIGHTS;
  item->cmsg_len = CMSG_LEN(sizeof(int));
  const int number = handle.get();
  std::memcpy(CMSG_DATA(item), &number, sizeof number);
  while (true) {
    const ssize_t size = ::sendmsg(socket, &message, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (size >= 0) return size;
    if (errno != EINTR) return failed_transfer();
  }
}

bool has_unreceived(int socket) {
  int waiting = 0;
  return ::ioctl(socket, SIOCOUTQ, &waiting) == 0 && waiting != 0;
}

std::ptrdiff_t receive_with_handle(int socket, std::span<std::byte> room, Descriptor& handle) {
  iovec piece{room.data(), room.size()};
  HandleRoom handles;
  msghdr message = message_of(piece, handles);
  while (true) {
    const ssize_t size = ::recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return failed_transfer();
    take_handles(message, handle);
    return size;
  }
}

bool sleep_on_shared(const SleepWord& word, std::uint32_t seen, std::chrono::nanoseconds time) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  timespec relative{};
  relative.tv_sec = seconds.count();
  relative.tv_nsec = (time - seconds).count();
  const long result = syscall(SYS_futex, &word, FUTEX_WAIT, seen, &relative, nullptr, 0);
  return result == 0 || errno != ETIMEDOUT;
}

void wake_shared(const SleepWord* word) {
  syscall(SYS_futex, word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

std::uint32_t current_processor() {
  const int number = ::sched_getcpu();
  return number < 0 ? 0 : static_cast<std::uint32_t>(number);
}

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace rr::platform
