// SPDX-License-Identifier: Apache-2.0
// What it costs to read a definition grows with its size, whatever is in it: a client reads what a
// service sends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/describe.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::model {
namespace {

// Definitions that grow with a number.
struct Hostile {
  std::string name;
  std::function<std::vector<std::string>(int)> texts;
};

std::string numbered(const std::string& name, int number) { return name + std::to_string(number); }

std::string repeated(int count, const std::function<std::string(int)>& part) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part(i);
  return text;
}

std::string file(const std::string& body) { return "service x.evil\nstdver 0.10\n" + body; }

// One text.
Hostile one(std::string name, std::function<std::string(int)> body) {
  return {std::move(name),
          [body = std::move(body)](int n) { return std::vector<std::string>{file(body(n))}; }};
}

const std::vector<Hostile>& hostile() {
  static const std::vector<Hostile> all = {
      one("names that are nearly those of structs",
          [](int n) {
            return repeated(n,
                            [](int i) {
                              return numbered("struct Alpha", i) + "\nfield double a\nend\n";
                            }) +
                   "object Root\n" +
                   repeated(n,
                            [](int i) {
                              return numbered("property Alphb", i) + numbered(" p", i) + "\n";
                            }) +
                   "end\n";
          }),
      one("using lines that name nothing",
          [](int n) {
            return "import x.other\n" +
                   repeated(n, [](int i) { return numbered("using x.other.Alphb", i) + "\n"; });
          }),
      one("structs in circles",
          [](int n) {
            return repeated(n, [](int i) {
              const std::string a = numbered("A", i);
              return "pod " + a + "\nfield " + a + "[2] a\nend\n";
            });
          }),
      one("a large circle with many chords",
          [](int n) {
            return repeated(n, [n](int i) {
              return numbered("pod P", i) + "\n" + numbered("field P", (i + 1) % n) +
                     "[2] a\nfield P0[2] b\nend\n";
            });
          }),
      one("objects that implement each other in circles",
          [](int n) {
            return repeated(n, [n](int i) {
              return numbered("object O", i) + "\n" + numbered("implements O", (i + 1) % n) +
                     "\nimplements O0\nproperty double a\nend\n";
            });
          }),
      one("a long chain of objects",
          [](int n) {
            return repeated(n, [n](int i) {
              return numbered("object O", i) + "\n" +
                     (i + 1 < n ? numbered("implements O", i + 1) + "\n" : "") +
                     "property double a\nend\n";
            });
          }),
      one("objects that do not repeat a wide one",
          [](int n) {
            return "object Base\n" +
                   repeated(n, [](int i) { return numbered("property double p", i) + "\n"; }) +
                   "end\n" + repeated(n, [](int i) {
                     return numbered("object O", i) + "\nimplements Base\nend\n";
                   });
          }),
      one("objects that do not list what a wide one implements",
          [](int n) {
            return repeated(n, [](int i) { return numbered("object B", i) + "\nend\n"; }) +
                   "object Base\n" +
                   repeated(n, [](int i) { return numbered("implements B", i) + "\n"; }) + "end\n" +
                   repeated(n, [](int i) {
                     return numbered("object O", i) + "\nimplements Base\nend\n";
                   });
          }),
      one("one implements line again and again",
          [](int n) {
            return "object Base\n" +
                   repeated(n, [](int i) { return numbered("property double p", i) + "\n"; }) +
                   "end\nobject Root\n" + repeated(n, [](int) { return "implements Base\n"; }) +
                   "end\n";
          }),
      one("members of one name",
          [](int n) {
            return "object Root\n" + repeated(n, [](int) { return "property double p\n"; }) +
                   "end\n";
          }),
      one("parameters of one name",
          [](int n) {
            return "object Root\nfunction void f(" +
                   repeated(n, [](int i) { return std::string(i == 0 ? "" : ", ") + "int32 p"; }) +
                   ")\nend\n";
          }),
      one("modifiers that nobody knows",
          [](int n) {
            return "object Root\nproperty double p [" +
                   repeated(n, [](int i) { return (i == 0 ? "m" : ", m") + std::to_string(i); }) +
                   "]\nend\n";
          }),
      one("modifiers that are repeated",
          [](int n) {
            return "object Root\nproperty double p [" +
                   repeated(n, [](int i) { return i == 0 ? "urgent" : ", urgent"; }) + "]\nend\n";
          }),
      one("a chain of constants",
          [](int n) {
            return "constant double K0 1\n" + repeated(n, [](int i) {
                     return numbered("constant struct C", i) +
                            " {a: " + (i == 0 ? std::string("K0") : numbered("C", i - 1)) + "}\n";
                   });
          }),
      one("constants that contain themselves",
          [](int n) {
            return repeated(n, [](int i) {
              return numbered("constant struct C", i) + " {a: " + numbered("C", i) + "}\n";
            });
          }),
      one("constants that do not exist",
          [](int n) {
            return repeated(n, [](int i) {
              return numbered("constant struct C", i) + " {a: " + numbered("Missing", i) + "}\n";
            });
          }),
      one("a wide enum",
          [](int n) {
            return "enum E\n" +
                   repeated(
                       n,
                       [](int i) { return numbered(" E", i) + (i == 0 ? " = 0" : "") + ",\n"; }) +
                   " Last\nend\n";
          }),
      one("an enum of one value",
          [](int n) {
            return "enum E\n" +
                   repeated(n,
                            [n](int i) {
                              return numbered(" E", i) + " = 7" + (i + 1 == n ? "" : ",") + "\n";
                            }) +
                   "end\n";
          }),
      one("braces behind a type",
          [](int n) {
            return "object Root\nproperty string" +
                   repeated(n, [](int) { return std::string("{list}"); }) + " s\nend\n";
          }),
      one("a long name",
          [](int n) {
            return "object Root\nproperty string " +
                   std::string(static_cast<std::size_t>(n) * 8, 's') + "\nend\n";
          }),
      one("a long array of dimensions",
          [](int n) {
            return "object Root\nproperty double[" +
                   repeated(n, [](int i) { return std::string(i == 0 ? "2" : ",2"); }) +
                   "] p\nend\n";
          }),
      one("lines that are no lines",
          [](int n) {
            return repeated(n, [](int i) { return numbered("wrong%line", i) + "\n"; }) +
                   "object Root\n" +
                   repeated(n,
                            [](int i) {
                              return numbered("property Missing", i) + numbered(" p", i) + "\n";
                            }) +
                   "end\n";
          }),
      one("a line of mistakes",
          [](int n) {
            return "object Root\nproperty double " +
                   repeated(n, [](int) { return std::string("% ] "); }) + "\n" +
                   repeated(n,
                            [](int i) {
                              return numbered("property Missing", i) + numbered(" p", i) + "\n";
                            }) +
                   "end\n";
          }),
      one("a line that goes on and on",
          [](int n) {
            return "object Root\nfunction void f(\\\n" +
                   repeated(n,
                            [](int i) {
                              return (i == 0 ? " " : " ,") + numbered("int32 p", i) + "\\\n";
                            }) +
                   ")\nend\n";
          }),
      one("documentation",
          [](int n) {
            return repeated(n, [](int i) { return numbered("## text ", i) + "\n"; }) +
                   "object Root\nend\n";
          }),
      one("options",
          [](int n) {
            return "object Root\n" +
                   repeated(n,
                            [](int i) {
                              return numbered("option pipe p", i) + " unreliable\n" +
                                     numbered("pipe double p", i) + "\n";
                            }) +
                   "end\n";
          }),
      {"many imports of each other",
       [](int n) {
         const int count = std::max(2, n / 40);
         std::vector<std::string> texts;
         for (int i = 0; i < count; ++i) {
           texts.push_back(numbered("service x.d", i) + "\nstdver 0.10\n" +
                           repeated(40, [&](int j) {
                             return numbered("import x.d", (i + j + 1) % count) + "\n";
                           }));
         }
         return texts;
       }},
      {"imports that are not found",
       [](int n) {
         return std::vector<std::string>{
             file(repeated(n, [](int i) { return numbered("import x.missing", i) + "\n"; }))};
       }},
  };
  return all;
}

// Seconds of this process's time that reading takes, with all passes.
double cost(const std::vector<std::string>& texts, Origin origin) {
  const std::clock_t begin = std::clock();
  std::vector<ast::NamedText> named;
  for (const std::string& text : texts) named.push_back({"a", text});
  Sources sources;
  Report report(origin);
  const ast::Program program = ast::read_texts(std::move(named), sources, report);
  Model model = resolve(program, sources, report);
  evaluate(model, report);
  lay_out(model, report);
  check(model, report);
  static_cast<void>(report.sorted());
  static_cast<void>(dump(model, sources));
  for (const auto& definition : model.definitions()) static_cast<void>(describe(*definition));
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

class Growth : public testing::TestWithParam<Origin> {};

// Four times the text in less than twelve times the time. What is over at once is not compared.
TEST_P(Growth, IsThatOfTheText) {
  constexpr int small = 1000;
  constexpr double at_once = 0.15;
  for (const Hostile& one : hostile()) {
    double first = 0;
    double second = 0;
    for (int attempt = 0; attempt < 3; ++attempt) {
      first = cost(one.texts(small), GetParam());
      second = cost(one.texts(4 * small), GetParam());
      if (second < std::max(12 * first, at_once)) break;
    }
    EXPECT_LT(second, std::max(12 * first, at_once))
        << one.name << ": " << first << " s, four times as much " << second << " s";
    if (std::getenv("ROBDEF_GROWTH") != nullptr) {
      std::printf("%8.3f %8.3f  %s\n", first, second, one.name.c_str());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Texts, Growth, testing::Values(Origin::user, Origin::network),
                         [](const auto& tested) {
                           return tested.param == Origin::user ? "OfAUser" : "OfTheNetwork";
                         });

}  // namespace
}  // namespace robdef::model
