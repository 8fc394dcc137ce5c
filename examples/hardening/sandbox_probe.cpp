// SPDX-License-Identifier: Apache-2.0
// Tries, under the settings of a unit, what somebody would try who has taken over its service.
#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/klog.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/personality.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <functional>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace {

constexpr const char* usage =
    "usage: sandbox_probe FOLDER STATE | memory\n"
    "Run it by a unit in place of its service. FOLDER is the configuration of the service, STATE\n"
    "where it may write. Prints a line for each try, and fails when one gets through. `memory`\n"
    "takes 1 GiB, and should not come to its end.\n";

/// 0 when the try got through, else the error.
int error_of(long result) { return result < 0 ? errno : 0; }

int open_file(const std::string& path, int flags) {
  const int file = open(path.c_str(), flags | O_CLOEXEC, 0600);
  if (file < 0) return errno;
  close(file);
  return 0;
}

int see_files_in(const std::string& path) {
  DIR* folder = opendir(path.c_str());
  if (folder == nullptr) return errno;
  int count = 0;
  while (const dirent* entry = readdir(folder)) {
    const std::string name = entry->d_name;
    count += static_cast<int>(name != "." && name != "..");
  }
  closedir(folder);
  return count == 0 ? ENOENT : 0;
}

int make_suid_program(const std::string& folder) {
  const std::string path = folder + "/suid";
  if (const int error = open_file(path, O_WRONLY | O_CREAT); error != 0) return error;
  const int error = error_of(chmod(path.c_str(), 04755));
  unlink(path.c_str());
  return error;
}

int map_writable_code() {
  void* memory =
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? errno : 0;
}

int make_data_code() {
  void* memory = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? errno : error_of(mprotect(memory, 4096, PROT_READ | PROT_EXEC));
}

int run_in_real_time() {
  sched_param parameters{};
  parameters.sched_priority = 10;
  return error_of(sched_setscheduler(0, SCHED_FIFO, &parameters));
}

int set_clock() {
  timeval now{};
  gettimeofday(&now, nullptr);
  return error_of(settimeofday(&now, nullptr));
}

int send_to(const char* address) {
  const int socket_of = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_of < 0) return errno;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(9);
  inet_pton(AF_INET, address, &to.sin_addr);
  const int error =
      error_of(sendto(socket_of, "x", 1, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to));
  close(socket_of);
  return error;
}

int start_threads(int count) {
  std::mutex mutex;
  std::condition_variable news;
  bool ends = false;
  std::vector<std::thread> threads;
  int error = 0;
  try {
    while (static_cast<int>(threads.size()) < count) {
      threads.emplace_back([&] {
        std::unique_lock lock(mutex);
        news.wait(lock, [&] { return ends; });
      });
    }
  } catch (const std::system_error& refused) {
    error = refused.code().value();
  }
  {
    const std::lock_guard lock(mutex);
    ends = true;
  }
  news.notify_all();
  for (std::thread& thread : threads) thread.join();
  return error;
}

int open_many_files(int count) {
  std::vector<int> files;
  int error = 0;
  while (error == 0 && static_cast<int>(files.size()) < count) {
    const int file = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (file < 0) {
      error = errno;
    } else {
      files.push_back(file);
    }
  }
  for (const int file : files) close(file);
  return error;
}

int leave_core_dumps() {
  rlimit limit{};
  getrlimit(RLIMIT_CORE, &limit);
  return limit.rlim_max == 0 ? EPERM : 0;
}

struct Try {
  const char* what;
  std::function<int()> run;
};

int report(const std::vector<Try>& tries, bool should_work) {
  int wrong = 0;
  for (const Try& attempt : tries) {
    const int error = attempt.run();
    const bool is_right = (error == 0) == should_work;
    wrong += static_cast<int>(!is_right);
    std::printf("%s%s: %s\n", is_right ? "" : "WRONG: ", error == 0 ? "works" : "refused",
                error == 0
                    ? attempt.what
                    : (std::string(attempt.what) + " (" + std::strerror(error) + ")").c_str());
  }
  return wrong;
}

void take_memory() {
  constexpr std::size_t piece = 1 << 20;
  for (int i = 0; i < 1024; ++i) {
    void* memory = mmap(nullptr, piece, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return;
    std::memset(memory, 1, piece);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "memory") {
    take_memory();
    std::puts("WRONG: works: to take 1 GiB");
    return 0;
  }
  if (argc != 3) {
    std::fputs(usage, stderr);
    return 2;
  }
  const std::string folder = argv[1];
  const std::string state = argv[2];
  int wrong = report(
      {
          {"to read the own certificate",
           [&] { return open_file(folder + "/node.cert.pem", O_RDONLY); }},
          {"to write the own state",
           [&] { return open_file(state + "/probe", O_WRONLY | O_CREAT); }},
          {"to send to this machine", [] { return send_to("127.0.0.1"); }},
      },
      true);
  unlink((state + "/probe").c_str());
  wrong += report(
      {
          {"to write the own key", [&] { return open_file(folder + "/node.key", O_WRONLY); }},
          {"to write below /etc", [&] { return open_file("/etc/probe", O_WRONLY | O_CREAT); }},
          {"to write below /usr",
           [] { return open_file("/usr/local/bin/probe", O_WRONLY | O_CREAT); }},
          {"to see homes", [] { return see_files_in("/home"); }},
          {"to see the home of root", [] { return see_files_in("/root"); }},
          {"to see temporary files of others", [] { return see_files_in("/tmp"); }},
          {"to read the certificate authority", [] { return see_files_in("/var/lib/robdef-ca"); }},
          {"to read memory by /dev/mem", [] { return open_file("/dev/mem", O_RDONLY); }},
          {"to become root", [] { return error_of(setuid(0)); }},
          {"to make a set-uid program", [&] { return make_suid_program(state); }},
          {"to map writable code", map_writable_code},
          {"to turn data into code", make_data_code},
          {"to change the personality", [] { return error_of(personality(ADDR_NO_RANDOMIZE)); }},
          {"to run in real time", run_in_real_time},
          {"to make a user namespace", [] { return error_of(unshare(CLONE_NEWUSER)); }},
          {"to mount", [] { return error_of(mount("none", "/mnt", "tmpfs", 0, nullptr)); }},
          {"to trace a process",
           [] { return error_of(ptrace(PTRACE_TRACEME, 0, nullptr, nullptr)); }},
          {"to set the clock", set_clock},
          {"to set the host name", [] { return error_of(sethostname("probe", 5)); }},
          {"to read the kernel's log", [] { return error_of(klogctl(10, nullptr, 0)); }},
          {"to set kernel variables",
           [] { return open_file("/proc/sys/kernel/core_pattern", O_WRONLY); }},
          {"to change control groups",
           [] { return open_file("/sys/fs/cgroup/probe", O_WRONLY | O_CREAT); }},
          {"to see process 1", [] { return open_file("/proc/1/status", O_RDONLY); }},
          {"to make a packet socket", [] { return error_of(socket(AF_PACKET, SOCK_RAW, 0)); }},
          {"to send to a foreign network", [] { return send_to("203.0.113.9"); }},
          {"to start 64 threads more", [] { return start_threads(64); }},
          {"to open 4,096 files more", [] { return open_many_files(4096); }},
          {"to leave core dumps", leave_core_dumps},
      },
      false);
  return wrong == 0 ? 0 : 1;
}
