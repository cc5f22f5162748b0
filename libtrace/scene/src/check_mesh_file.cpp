#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>

#include "import_util.h"
#include "material/error.h"
#include "scene/limits.h"
#include "scene/mesh_io.h"

namespace atrium::scene {
namespace {

/// NumberOfPoints="12", NumberOfTuples = '3': a number behind the rest of a name, = and a quote.
std::uint64_t announced(std::string_view text) {
  const std::size_t begin = text.find_first_of("0123456789");
  const std::size_t end = text.find_first_of("<>");
  if (begin == std::string_view::npos || begin > end) return 0;
  std::uint64_t value = 0;
  const auto [rest, code] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  return code == std::errc::result_out_of_range ? ~std::uint64_t{0} : value;
}

constexpr std::array kElements = {"VTKFile",        "PolyData",  "UnstructuredGrid",
                                  "Piece",          "FieldData", "PointData",
                                  "CellData",       "Points",    "Cells",
                                  "Verts",          "Lines",     "Strips",
                                  "Polys",          "DataArray", "Array",
                                  "InformationKey", "Value",     "AppendedData"};
constexpr std::array kTypes = {"Int8",  "UInt8",  "Int16",   "UInt16",  "Int32",  "UInt32",
                               "Int64", "UInt64", "Float32", "Float64", "String", "Bit"};

bool is_one_of(std::string_view word, const auto& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The value of type="..." in a tag; empty: none.
std::string_view type_of(std::string_view tag) {
  constexpr std::string_view kBlank = " \t\r\n";
  constexpr std::string_view kName = "type=";
  std::size_t at = tag.find(kName);
  while (at != tag.npos && (at == 0 || kBlank.find(tag[at - 1]) == kBlank.npos))
    at = tag.find(kName, at + 1);
  if (at == tag.npos || at + kName.size() + 1 >= tag.size()) return {};
  const std::string_view value = tag.substr(at + kName.size() + 1);
  return value.substr(0, value.find(tag[at + kName.size()]));
}

/// VTK follows a null pointer for arrays of a type that it does not know, whatever their element is
/// called: only what files of this kind have is let through, and no declarations. Texts are of the
/// whole file; those of points and cells it would write behind the end of their array.
std::string what_is_unknown(std::string_view text) {
  bool in_piece = false;
  for (std::size_t at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
    std::string_view tag = text.substr(at + 1);
    if (tag.starts_with("/Piece")) in_piece = false;
    if (tag.starts_with("?xml ") || tag.starts_with("!--") || tag.starts_with("/")) continue;
    tag = tag.substr(0, tag.find('>'));
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (name == "AppendedData") return {};  // no XML from here on
    if (!is_one_of(name, kElements)) return "element '" + std::string(name.substr(0, 40)) + "'";
    in_piece = in_piece || name == "Piece";
    if ((name == "DataArray" || name == "Array") &&
        (!is_one_of(type_of(tag), kTypes) || (in_piece && type_of(tag) == "String")))
      return "type '" + std::string(type_of(tag).substr(0, 40)) + "' of an array";
  }
  return {};
}

/// The text with an empty element for arrays of points in the pieces that do not begin with one, as
/// VTK writes them; empty if all do.
std::string with_point_data(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::string_view xml = text.substr(0, text.find("<AppendedData"));
  std::string result;
  std::size_t copied = 0;
  for (std::size_t at = xml.find("<Piece"); at != xml.npos; at = xml.find("<Piece", at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == xml.npos) break;
    const std::size_t next = std::min(xml.find_first_not_of(kBlank, end + 1), xml.size());
    if (xml[end - 1] == '/' || xml.substr(next).starts_with("<PointData")) continue;
    result.append(text, copied, end + 1 - copied).append("<PointData></PointData>");
    copied = end + 1;
  }
  return copied > 0 ? result.append(text, copied) : result;
}

}  // namespace

std::string check_mesh_file(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file, limits::kMeshFileBytes);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (const std::string unknown = what_is_unknown(text); !unknown.empty())
    throw Error(file.string() + ": is damaged or no mesh file: unknown " + unknown);
  const bool packed = text.substr(0, text.find("<Piece")).find("compressor") != text.npos;
  const std::uint64_t most = (packed ? limits::kPackedNumbersPerByte : 1) * bytes.size();
  constexpr std::string_view kWord = "NumberOf";
  for (std::size_t at = text.find(kWord); at != text.npos; at = text.find(kWord, at + 1)) {
    const std::uint64_t number = announced(text.substr(at, 200));
    if (number > most)
      throw Error(file.string() + ": announces " + std::to_string(number) +
                  " points, cells or values, more than its " + std::to_string(bytes.size()) +
                  " bytes can hold");
  }
  return with_point_data(text);
}

}  // namespace atrium::scene
