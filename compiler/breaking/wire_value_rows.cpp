// SPDX-License-Identifier: Apache-2.0
// Values of other types: what the receiver makes of them.
#include "compiler/breaking/testing.hpp"
#include "compiler/breaking/wire_rows.hpp"

namespace robdef::breaking::testing {
namespace {

using rr::dynamic::IntMap;
using rr::dynamic::List;
using rr::dynamic::StringMap;
using rr::dynamic::Value;

// Whatever the value is.
std::string reads(Meeting& meeting) {
  static_cast<void>(meeting.object.get("v"));
  return "read";
}

Row property(std::string name, std::string codes, const std::string& before, const std::string& now,
             Serve serve, Use use, std::string old_client, std::string new_client) {
  return members(std::move(name), std::move(codes), "property " + before + " v",
                 "property " + now + " v", std::move(serve), std::move(use), std::move(old_client),
                 std::move(new_client));
}

const StringMap x{{"x", 1.0}};
const StringMap xy{{"x", 1.0}, {"y", 2.0}};
const StringMap xz{{"x", 1.0}, {"z", 2.0}};

// The same value as of a type called T and one called U.
Row renamed(const std::string& name, const std::string& codes, const std::string& kind,
            const std::string& form, const Value& value, const std::string& old_client,
            const std::string& new_client) {
  Row row = types(name, codes, kind + " T\nfield double x", kind + " U\nfield double x",
                  stores(value), get, old_client, new_client, "T" + form);
  row.now.replace(row.now.rfind("T" + form), 1, "U");
  return row;
}

}  // namespace

std::vector<Row> value_rows() {
  return {
      property("another type of number", "R0705", "double", "single", stores(1.5), get,
               "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      property("another type of number, set", "R0705", "double", "int32", stores(1), sets(2),
               "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      property("a number that becomes an array", "R0705", "double", "double[]",
               stores(1.5, List{2.5, 1.5}), get, "silent: 2.5", "silent: [1.5]"),
      property("a number that becomes text", "R0705", "double", "string", stores(1.5, "a"), get,
               "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      property("an array that becomes a list", "R0705", "double[]", "double{list}",
               stores(List{1.5}), get, "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      property("a list that becomes a map", "R0705", "double{list}", "double{int32}",
               stores(List{1.0}, IntMap{{0, 1.0}}), sets(List{1.0}, IntMap{{0, 1.0}}),
               "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      property("an array that gets dimensions", "R0705", "double[]", "double[*]", stores(List{1.5}),
               get, "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      property("an array that becomes a varvalue with one", "R0705", "double[]", "varvalue",
               stores(List{1.5}, rr::Array<double>{1.5}), get, "works", "works"),
      property("an array that becomes a varvalue with something else", "R0705", "double[]",
               "varvalue", stores(List{1.5}, "a"), reads, "refused: DataTypeMismatch", "works"),
      property("another length", "R0706", "double[3]", "double[4]",
               stores(List{1, 2, 3}, List{1, 2, 3, 4}), get, "refused: DataTypeError",
               "refused: DataTypeError"),
      property("a wider limit", "R0706", "double[2-]", "double[3-]", stores(List{1}, List{1, 2, 3}),
               reads, "refused: DataTypeError", "works"),
      property("a narrower limit", "R0706", "double[3-]", "double[2-]", stores(List{1}),
               sets(List{1, 2, 3}, List{1, 2}), "refused: DataTypeError", "works"),
      property("a limit that is gone", "R0706", "double[2-]", "double[]",
               stores(List{1}, List{1, 2, 3}), reads, "refused: DataTypeError", "works"),
      property("another shape", "R0706", "double[2,2]", "double[4,1]",
               stores(Value(rr::MultiArray<double>{{2, 2}, {1, 2, 3, 4}}),
                      Value(rr::MultiArray<double>{{4, 1}, {1, 2, 3, 4}})),
               get, "refused: DataTypeError", "refused: DataTypeError"),
  };
}

std::vector<Row> record_rows() {
  Row enum_to_number = types(
      "an enum that becomes a number", "R0744", "enum T\na = 1", "enum T\na = 1", stores(1),
      [](Meeting& meeting) { return std::to_string(meeting.object.get("v").as<int>()); }, "works",
      "works");
  enum_to_number.now.replace(enum_to_number.now.rfind("T v"), 1, "int32");
  Row enum_renamed = types("an enum with another name", "R0741", "enum T\na = 1", "enum U\na = 1",
                           stores(1), get, "works", "works");
  enum_renamed.now.replace(enum_renamed.now.rfind("T v"), 1, "U");
  Row other = types("another struct with the same fields", "R0705",
                    "struct T\nfield double x\nend\nstruct U\nfield double x",
                    "struct T\nfield double x\nend\nstruct U\nfield double x", stores(x), get,
                    "refused: DataTypeMismatch", "refused: DataTypeMismatch");
  other.now.replace(other.now.rfind("T v"), 1, "U");
  Row varvalue = types("a renamed struct in a varvalue", "R0715", "struct T\nfield double x",
                       "struct U\nfield double x", serve_nothing, get, "refused: ServiceError",
                       "refused: ServiceError", "varvalue");
  varvalue.serve = [](const rr::dynamic::ServedObject& object, bool is_new) {
    object.store("v", object.types().type(is_new ? "x.t.U" : "x.t.T").convert(x));
  };
  return {
      types("a new field of a struct that comes", "R0710", "struct T\nfield double x",
            "struct T\nfield double x\nfield double y", stores(x, xy), gets("x"), "works",
            "refused: MessageElementNotFound"),
      types("a new field of a struct that is sent", "R0710", "struct T\nfield double x",
            "struct T\nfield double x\nfield double y", stores(x, xy), sets(x, xy),
            "refused: MessageElementNotFound", "works"),
      types("a new field of a pod that comes", "R0710", "pod T\nfield double x",
            "pod T\nfield double x\nfield double y", stores(x, xy), gets("x"), "works",
            "refused: MessageElementNotFound"),
      types("a new field of a pod that is sent", "R0710", "pod T\nfield double x",
            "pod T\nfield double x\nfield double y", stores(x, xy), sets(x, xy),
            "refused: MessageElementNotFound", "works"),
      types("a field of a struct that is gone", "R0711", "struct T\nfield double x\nfield double y",
            "struct T\nfield double x", stores(xy, x), gets("x"), "refused: MessageElementNotFound",
            "works"),
      types("a field of a struct with another name", "R0711",
            "struct T\nfield double x\nfield double y", "struct T\nfield double x\nfield double z",
            stores(xy, xz), gets("x"), "refused: MessageElementNotFound",
            "refused: MessageElementNotFound"),
      types("a field of a pod with another name", "R0711", "pod T\nfield double x\nfield double y",
            "pod T\nfield double x\nfield double z", stores(xy, xz), gets("x"),
            "refused: MessageElementNotFound", "refused: MessageElementNotFound"),
      types("a field of another type", "R0705", "struct T\nfield double x",
            "struct T\nfield single x", stores(x), gets("x"), "refused: DataTypeMismatch",
            "refused: DataTypeMismatch"),
      types("a field of a pod with another length", "R0706", "pod T\nfield double[2] x",
            "pod T\nfield double[3] x",
            stores(StringMap{{"x", List{1, 2}}}, StringMap{{"x", List{1, 2, 3}}}), gets("x"),
            "refused: DataTypeError", "refused: DataTypeError"),
      types("fields of a struct in another order", "R0779",
            "struct T\nfield double x\nfield double y", "struct T\nfield double y\nfield double x",
            stores(xy), gets("x"), "works", "works"),
      types("fields of a pod in another order", "R0712", "pod T\nfield double x\nfield double y",
            "pod T\nfield double y\nfield double x", stores(xy), gets("x"), "works", "works"),
      types(
          "fields of pods in an array in another order", "R0712",
          "pod T\nfield double x\nfield double y", "pod T\nfield double y\nfield double x",
          stores(List{xy}),
          [](Meeting& meeting) {
            return meeting.object.get("v").at(std::size_t{0})["x"].to_json();
          },
          "works", "works", "T[]"),
      types("numbers of a namedarray in another order", "R0713",
            "namedarray T\nfield double x\nfield double y",
            "namedarray T\nfield double y\nfield double x", stores(xy), gets("x"), "silent: 2",
            "silent: 2"),
      types("more numbers in a namedarray", "R0713", "namedarray T\nfield double x",
            "namedarray T\nfield double x\nfield double y", stores(x, xy), gets("x"),
            "refused: DataTypeError", "refused: DataTypeError"),
      types(
          "more numbers in namedarrays of an array", "R0713", "namedarray T\nfield double x",
          "namedarray T\nfield double x\nfield double y", stores(List{x}, List{xy}),
          [](Meeting& meeting) { return std::to_string(meeting.object.get("v").size()); },
          "silent: 2", "refused: DataTypeError", "T[]"),
      types("another type of number in a namedarray", "R0713", "namedarray T\nfield double x",
            "namedarray T\nfield single x", stores(x), gets("x"), "refused: DataTypeMismatch",
            "refused: DataTypeMismatch"),
      types("another name in a namedarray", "R0746", "namedarray T\nfield double x\nfield double y",
            "namedarray T\nfield double x\nfield double z", stores(xy, xz), gets("x"), "works",
            "works"),
      types(
          "other fields for the numbers of a namedarray", "R0746",
          "namedarray T\nfield double x\nfield double y", "namedarray T\nfield double[2] v",
          stores(xy, StringMap{{"v", List{1.0, 2.0}}}),
          [](Meeting& meeting) {
            const Value value = meeting.object.get("v");
            return (meeting.is_client_new ? value["v"].at(std::size_t{1}) : value["y"]).to_json();
          },
          "works", "works"),
      types("a struct that becomes a pod", "R0714", "struct T\nfield double x",
            "pod T\nfield double x", stores(x), gets("x"), "refused: DataTypeMismatch",
            "refused: DataTypeMismatch"),
      types("a pod that becomes a namedarray", "R0714", "pod T\nfield double x",
            "namedarray T\nfield double x", stores(x), gets("x"), "refused: DataTypeMismatch",
            "refused: DataTypeMismatch"),
      renamed("a struct with another name", "R0715", "struct", "", x, "refused: ServiceError",
              "refused: ServiceError"),
      renamed("a pod with another name", "R0715", "pod", "", x, "refused: DataTypeError",
              "refused: DataTypeError"),
      renamed("pods with another name in an array", "R0715", "pod", "[]", List{x},
              "refused: DataTypeError", "refused: DataTypeError"),
      renamed("a namedarray with another name", "R0715", "namedarray", "", x,
              "refused: DataTypeError", "refused: DataTypeError"),
      varvalue,
      other,
      enum_to_number,
      enum_renamed,
  };
}

}  // namespace robdef::breaking::testing
