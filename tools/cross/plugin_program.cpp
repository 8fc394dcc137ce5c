// SPDX-License-Identifier: Apache-2.0
// A plug-in for tools/cross/compare_compilers.py: reads the whole request, says how long it is, and makes one file of it.
// Built for each system, since plug-ins of the other tests are scripts.
#include <cstdio>
#include <string>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

int main() {
#ifdef _WIN32
  _setmode(_fileno(stdin), _O_BINARY);
#endif
  std::string request;
  for (int letter = std::getchar(); letter != EOF; letter = std::getchar()) {
    request += static_cast<char>(letter);
  }
  std::fprintf(stderr, "read %zu bytes\n", request.size());
  std::string content;
  for (const char letter : request) {
    if (letter == '"' || letter == '\\') content += '\\';
    content += letter == '\n' ? ' ' : letter;
  }
  std::printf("{\"files\": [{\"path\": \"folder/request.txt\", \"content\": \"%s\"}]}",
              content.c_str());
}
