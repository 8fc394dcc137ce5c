// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/print.hpp"

#include <string>

#include "compiler/model/compiled.hpp"
#include "compiler/model/describe.hpp"
#include "compiler/model/dump.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Print, ADefinitionHasOneForm) {
  const Compiled result = compiled(
      {"# comment\nservice example.t\nstdver 0.10\nimport example.base\n"
       "using example.base.Point as Place\nusing example.base.Line\n"
       "exception Broken\nenum E\na = 0x10, b,\nc = -1,\nend\n"
       "constant  string  C  \"q\\\"\\\\\\u00e9\\ud83d\\ude00\"\nconstant int32[] A { 1,0x2 }\n"
       "constant struct D {a: A}\n"
       "object O\nconstant int16 K -1\nproperty Place[3-]{list} p [readonly,special(K,2)]\n"
       "function Line{generator} f( double[*]  x , int32{generator} y )\nevent e()\n"
       "objref O[] o\nproperty example.base.Far f2\nend\n"
       "namedarray N\nfield double[2] x\nend\nstruct S\n## documented\nfield double[4,] x\nend\n",
       "service example.base\nstdver 0.10\nstruct Point\nend\nstruct Line\nend\nstruct "
       "Far\nend\n"});
  // Places of structs in arrays are refused, which does not concern the printer.
  EXPECT_EQ(print(result.definition(0)),
            "service example.t\n"
            "stdver 0.10\n"
            "import example.base\n"
            "using example.base.Point as Place\n"
            "using example.base.Line\n"
            "constant string C \"q\\\"\\\\\\u00e9\\ud83d\\ude00\"\n"
            "constant int32[] A {1, 0x2}\n"
            "constant struct D {a: A}\n"
            "enum E\n"
            "    a = 0x10,\n"
            "    b = 0x11,\n"
            "    c = -1\n"
            "end\n"
            "exception Broken\n"
            "struct S\n"
            "    field double[4,] x\n"
            "end\n"
            "namedarray N\n"
            "    field double[2] x\n"
            "end\n"
            "object O\n"
            "    constant int16 K -1\n"
            "    property Place[3-]{list} p [readonly, special(K, 2)]\n"
            "    function Line{generator} f(double[*] x, int32{generator} y)\n"
            "    event e()\n"
            "    objref O{int32} o\n"
            "    property example.base.Far f2\n"
            "end\n");
}

TEST(Print, OldFilesKeepTheirOptions) {
  const Compiled result = compiled(
      {"service example.t\noption version 0.8\noption old thing\noption constant int32 A 1\n"
       "object O\noption pipe p unreliable\npipe double p\nend object\n"});
  EXPECT_EQ(print(result.definition(0)),
            "service example.t\n"
            "option version 0.8\n"
            "option old thing\n"
            "option constant int32 A 1\n"
            "object O\n"
            "    option pipe p unreliable\n"
            "    pipe double p\n"
            "end\n");
}

TEST(Print, TheSmallestHexadecimalEnumValueKeepsItsSign) {
  const Compiled result = compiled_lines("enum E\na = -0x80000000\nend\n");
  EXPECT_THAT(print(result.definition(0)), HasSubstr("    a = -0x80000000\n"));
}

TEST(Dump, AllKeysAreThereInTheirOrder) {
  const Compiled result = compiled({"service example.t\nconstant int32 A 1\n"});
  EXPECT_EQ(dump(result.model, *result.sources),
            "{\n"
            "  \"model_version\": 2,\n"
            "  \"definitions\": [\n"
            "    {\n"
            "      \"name\": \"example.t\",\n"
            "      \"file\": \"0.robdef\",\n"
            "      \"is_import\": false,\n"
            "      \"version\": \"\",\n"
            "      \"version_spelling\": \"none\",\n"
            "      \"version_span\": [\n        0,\n        0\n      ],\n"
            "      \"documentation\": \"\",\n"
            "      \"span\": [\n        8,\n        17\n      ],\n"
            "      \"imports\": [],\n"
            "      \"aliases\": [],\n"
            "      \"options\": [],\n"
            "      \"constants\": [\n"
            "        {\n"
            "          \"name\": \"A\",\n"
            "          \"type\": \"int32\",\n"
            "          \"value\": 1,\n"
            "          \"documentation\": \"\",\n"
            "          \"line\": 2,\n"
            "          \"span\": [\n            33,\n            34\n          ]\n"
            "        }\n"
            "      ],\n"
            "      \"exceptions\": [],\n"
            "      \"enums\": [],\n"
            "      \"structs\": [],\n"
            "      \"pods\": [],\n"
            "      \"namedarrays\": [],\n"
            "      \"objects\": [],\n"
            "      \"declarations\": [\n"
            "        \"A\"\n"
            "      ],\n"
            "      \"text\": \"service example.t\\nconstant int32 A 1\\n\",\n"
            "      \"lines\": [\n"
            "        {\n"
            "          \"kind\": \"statement\",\n"
            "          \"is_in_block\": false,\n"
            "          \"span\": [\n            0,\n            18\n          ],\n"
            "          \"tokens\": [\n"
            "            {\n"
            "              \"kind\": \"keyword\",\n"
            "              \"span\": [\n                0,\n                7\n              ]\n"
            "            },\n"
            "            {\n"
            "              \"kind\": \"name\",\n"
            "              \"span\": [\n                8,\n                17\n              ]\n"
            "            }\n"
            "          ]\n"
            "        },\n"
            "        {\n"
            "          \"kind\": \"statement\",\n"
            "          \"is_in_block\": false,\n"
            "          \"span\": [\n            18,\n            37\n          ],\n"
            "          \"tokens\": [\n"
            "            {\n"
            "              \"kind\": \"keyword\",\n"
            "              \"span\": [\n                18,\n                26\n              ]\n"
            "            },\n"
            "            {\n"
            "              \"kind\": \"name\",\n"
            "              \"span\": [\n                27,\n                32\n              ]\n"
            "            },\n"
            "            {\n"
            "              \"kind\": \"name\",\n"
            "              \"span\": [\n                33,\n                34\n              ]\n"
            "            },\n"
            "            {\n"
            "              \"kind\": \"number\",\n"
            "              \"span\": [\n                35,\n                36\n              ]\n"
            "            }\n"
            "          ]\n"
            "        }\n"
            "      ]\n"
            "    }\n"
            "  ]\n"
            "}\n");
}

TEST(Dump, AMemberCarriesWhatABackendNeeds) {
  const Compiled result = compiled_lines(
      "object O\nfunction double{generator} f(int32[3] a, string{generator} b) [urgent]\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_THAT(dump(result.model, *result.sources, Detail::shape),
              HasSubstr("            {\n"
                        "              \"kind\": \"function\",\n"
                        "              \"name\": \"f\",\n"
                        "              \"type\": {\n"
                        "                \"text\": \"double\",\n"
                        "                \"kind\": \"primitive\",\n"
                        "                \"name\": \"double\",\n"
                        "                \"array\": \"none\",\n"
                        "                \"dimensions\": [],\n"
                        "                \"container\": \"none\"\n"
                        "              },\n"
                        "              \"index\": \"none\",\n"
                        "              \"parameters\": [\n"
                        "                {\n"
                        "                  \"name\": \"a\",\n"
                        "                  \"type\": {\n"
                        "                    \"text\": \"int32[3]\",\n"
                        "                    \"kind\": \"primitive\",\n"
                        "                    \"name\": \"int32\",\n"
                        "                    \"array\": \"fixed_length\",\n"
                        "                    \"dimensions\": [\n"
                        "                      3\n"
                        "                    ],\n"
                        "                    \"container\": \"none\"\n"
                        "                  }\n"
                        "                }\n"
                        "              ],\n"
                        "              \"generator\": \"both\",\n"
                        "              \"generator_parameter\": {\n"
                        "                \"name\": \"b\",\n"));
}

TEST(Describe, AnOutlineHasDocumentationAndSizes) {
  const Compiled result = compiled_lines(
      "constant double LIMIT 1.5\n"
      "## Three numbers.\n## In metres.\nnamedarray V\nfield double x\nfield double y\nend\n"
      "object O\n## Moves.\nfunction void move(V to)\nwire V at [readonly]\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_EQ(describe(result.definition(0)),
            "service example.t  (version 0.10)\n"
            "\n"
            "constant double LIMIT 1.5\n"
            "\n"
            "namedarray V  (2 x double)\n"
            "    Three numbers.\n"
            "    In metres.\n"
            "  field double x\n"
            "  field double y\n"
            "\n"
            "object O\n"
            "  function void move(V to)\n"
            "      Moves.\n"
            "  wire V at [readonly]\n");
}

}  // namespace
}  // namespace robdef::model
