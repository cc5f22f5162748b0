#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string_view>

#include "import_util.h"
#include "material/error.h"
#include "model_budget.h"
#include "scene/limits.h"
#include "scene/scene_io.h"
#include "triangulate.h"

namespace atrium::scene {
namespace {

enum class Type : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float, Double };

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type = Type::Float;
  std::optional<Type> count;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  [[nodiscard]] int find(std::initializer_list<std::string_view> names) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (std::find(names.begin(), names.end(), properties[i].name) != names.end())
        return static_cast<int>(i);
    return -1;
  }
};

enum class Format { Ascii, LittleEndian, BigEndian };

struct Header {
  Format format = Format::Ascii;
  std::vector<Element> elements;
  std::size_t end = 0;  ///< offset of the data
};

/// The words of a line.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0;;) {
    at = line.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
}

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, std::string_view text)
      : file_(file), text_(text) {}

  Header read() {
    if (next_line() != "ply") fail("does not begin with 'ply'");
    Header header;
    bool format = false;
    for (;;) {
      const std::vector<std::string_view> words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() >= 2) {
        header.format = format_of(words[1]);
        format = true;
      } else if (words[0] == "element" && words.size() == 3) {
        header.elements.push_back({std::string(words[1]), count_of(words[2]), {}});
      } else if (words[0] == "property" && !header.elements.empty()) {
        header.elements.back().properties.push_back(property_of(words));
      } else {
        fail("is no line of a PLY header: '" + std::string(words[0]) + "'");
      }
    }
    if (!format) fail("the header names no format");
    header.end = at_;
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(file_.string() + ":" + std::to_string(line_) + ": " + what);
  }
  std::string_view next_line() {
    if (at_ >= text_.size()) fail("the file ends within the header");
    ++line_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  Format format_of(std::string_view word) const {
    if (word == "ascii") return Format::Ascii;
    if (word == "binary_little_endian") return Format::LittleEndian;
    if (word == "binary_big_endian") return Format::BigEndian;
    fail("unknown format '" + std::string(word) + "'");
  }
  std::uint64_t count_of(std::string_view word) const {
    std::uint64_t count = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (code != std::errc() || end != word.data() + word.size())
      fail("'" + std::string(word) + "' is no number of elements");
    return count;
  }
  Type type_of(std::string_view word) const {
    static const std::map<std::string_view, Type> known = {
        {"char", Type::Int8},     {"int8", Type::Int8},     {"uchar", Type::UInt8},
        {"uint8", Type::UInt8},   {"short", Type::Int16},   {"int16", Type::Int16},
        {"ushort", Type::UInt16}, {"uint16", Type::UInt16}, {"int", Type::Int32},
        {"int32", Type::Int32},   {"uint", Type::UInt32},   {"uint32", Type::UInt32},
        {"float", Type::Float},   {"float32", Type::Float}, {"double", Type::Double},
        {"float64", Type::Double}};
    const auto it = known.find(word);
    if (it == known.end()) fail("unknown type '" + std::string(word) + "'");
    return it->second;
  }
  Property property_of(const std::vector<std::string_view>& words) const {
    if (words.size() == 5 && words[1] == "list") {
      const Type count = type_of(words[2]);
      if (count == Type::Float || count == Type::Double) fail("a list is counted in whole numbers");
      return {std::string(words[4]), type_of(words[3]), count};
    }
    if (words.size() != 3)
      fail("a property is 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    return {std::string(words[2]), type_of(words[1]), std::nullopt};
  }

  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// The numbers behind the header, one by one.
class Values {
 public:
  Values(const std::filesystem::path& file, std::string_view data, Format format)
      : file_(file), data_(data), format_(format) {}

  double next(Type type) { return format_ == Format::Ascii ? next_word() : next_binary(type); }
  [[nodiscard]] std::size_t left() const { return data_.size(); }
  /// Can `count` elements of at least these sizes be in what is left?
  [[nodiscard]] bool may_hold(const Element& element) const {
    std::size_t least = format_ == Format::Ascii ? 2 * element.properties.size() : 0;
    if (format_ != Format::Ascii)
      for (const Property& p : element.properties) least += size_of(p.count.value_or(p.type));
    // The last number of a text needs nothing behind it.
    return least > 0 && element.count <= (data_.size() + 1) / least;
  }
  [[nodiscard]] bool may_hold_list(double count, Type type) const {
    const std::size_t least = format_ == Format::Ascii ? 2 : size_of(type);
    const std::size_t most = (data_.size() + 1) / least;
    return count >= 0.0 && count <= static_cast<double>(most);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(file_.string() + ": " + what);
  }

  double next_word() {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t begin = data_.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) fail("truncated: numbers are missing");
    data_.remove_prefix(begin);
    const std::string_view word = data_.substr(0, data_.find_first_of(kBlank));
    data_.remove_prefix(word.size());
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, code] = std::from_chars(first, word.data() + word.size(), value);
    if (code == std::errc::result_out_of_range)  // far below or beyond double
      return std::numeric_limits<double>::quiet_NaN();
    if (code != std::errc() || end != word.data() + word.size())
      fail("'" + std::string(word.substr(0, 40)) + "' is no number");
    return value;
  }

  template <class T>
  double load() {
    T value;
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), data_.data(), sizeof(T));
    if ((format_ == Format::LittleEndian) != (std::endian::native == std::endian::little))
      std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof(T));
    data_.remove_prefix(sizeof(T));
    return static_cast<double>(value);
  }
  double next_binary(Type type) {
    if (data_.size() < size_of(type)) fail("truncated: numbers are missing");
    switch (type) {
      case Type::Int8:
        return load<std::int8_t>();
      case Type::UInt8:
        return load<std::uint8_t>();
      case Type::Int16:
        return load<std::int16_t>();
      case Type::UInt16:
        return load<std::uint16_t>();
      case Type::Int32:
        return load<std::int32_t>();
      case Type::UInt32:
        return load<std::uint32_t>();
      case Type::Float:
        return load<float>();
      case Type::Double:
        break;
    }
    return load<double>();
  }

  const std::filesystem::path& file_;
  std::string_view data_;
  Format format_;
};

/// Colours as integers are shares of their type's largest value.
double color_scale(Type type) {
  switch (type) {
    case Type::UInt8:
      return 1.0 / 255.0;
    case Type::UInt16:
      return 1.0 / 65535.0;
    case Type::UInt32:
      return 1.0 / 4294967295.0;
    default:
      return 1.0;
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, const Header& header, Values values)
      : file_(file), header_(header), values_(values) {}

  MeshData read() {
    mesh_.name = file_.stem().string();
    for (const Element& element : header_.elements) {
      if (element.count == 0) continue;
      if (!values_.may_hold(element))
        throw Error(file_.string() + ": " + std::to_string(element.count) + " elements '" +
                    element.name + "' are more than the file's size holds");
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        skip(element);
    }
    cut_faces();
    return std::move(mesh_);
  }

 private:
  /// One element's numbers by property; of lists the first item.
  void read_row(const Element& element) {
    row_.assign(element.properties.size(), 0.0);
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& p = element.properties[i];
      if (!p.count) {
        row_[i] = values_.next(p.type);
        continue;
      }
      read_list(element, p);
      if (!list_.empty()) row_[i] = list_[0];
    }
  }
  void read_list(const Element& element, const Property& p) {
    const double count = values_.next(*p.count);
    if (!values_.may_hold_list(count, p.type) || count != std::floor(count))
      throw Error(file_.string() + ": a list '" + p.name + "' of '" + element.name +
                  "' is longer than the file");
    list_.resize(static_cast<std::size_t>(count));
    for (double& v : list_) v = values_.next(p.type);
  }
  void skip(const Element& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element);
  }

  void read_vertices(const Element& e) {
    const auto three = [&](const char* a, const char* b, const char* c) {
      return std::array{e.find({a}), e.find({b}), e.find({c})};
    };
    const auto there = [](const auto& places) {
      return std::all_of(places.begin(), places.end(), [](int i) { return i >= 0; });
    };
    const auto xyz = three("x", "y", "z");
    const auto normal = three("nx", "ny", "nz");
    const std::array color = {e.find({"red", "r"}), e.find({"green", "g"}), e.find({"blue", "b"})};
    const std::array uv = {e.find({"u", "s", "texture_u"}), e.find({"v", "t", "texture_v"})};
    if (!there(xyz)) throw Error(file_.string() + ": vertices have no x, y, z");
    const auto at = [&](int i) { return row_[static_cast<std::size_t>(i)]; };
    const auto shade = [&](int i) {
      return at(i) * color_scale(e.properties[static_cast<std::size_t>(i)].type);
    };
    for (std::uint64_t i = 0; i < e.count; ++i) {
      read_row(e);
      mesh_.positions.emplace_back(at(xyz[0]), at(xyz[1]), at(xyz[2]));
      if (there(normal))
        mesh_.normals.push_back(Vec3d(at(normal[0]), at(normal[1]), at(normal[2])).cast<float>());
      // PLY's v runs upwards, textures here start at the top.
      if (there(uv)) mesh_.uvs.push_back(Vec2d(at(uv[0]), 1.0 - at(uv[1])).cast<float>());
      if (there(color))
        mesh_.colors.push_back(Vec3d(shade(color[0]), shade(color[1]), shade(color[2]))
                                   .cast<float>()
                                   .cwiseMax(0.0f)
                                   .cwiseMin(1.0f));
    }
  }

  /// Corners first: faces may stand before the vertices.
  void read_faces(const Element& e) {
    const int corners = e.find({"vertex_indices", "vertex_index"});
    if (corners < 0 || !e.properties[static_cast<std::size_t>(corners)].count)
      throw Error(file_.string() + ": faces have no list vertex_indices");
    for (std::uint64_t i = 0; i < e.count; ++i) {
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        const Property& p = e.properties[k];
        if (!p.count) {
          static_cast<void>(values_.next(p.type));
          continue;
        }
        read_list(e, p);
        if (static_cast<int>(k) == corners) add_face();
      }
    }
  }
  void add_face() {
    const std::size_t face = sizes_.size();
    if (list_.size() > limits::kPolygonCorners)
      throw Error(file_.string() + ": face " + std::to_string(face) + " has too many corners");
    for (const double index : list_) {
      if (!(index >= 0.0 && index < 4294967295.0) || index != std::floor(index))
        throw Error(file_.string() + ": face " + std::to_string(face) + ": '" +
                    std::to_string(index) + "' is no vertex index");
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    sizes_.push_back(static_cast<std::uint32_t>(list_.size()));
  }

  void cut_faces() {
    std::vector<Vec3d> outline;
    std::size_t begin = 0;
    for (std::size_t face = 0; face < sizes_.size(); begin += sizes_[face++]) {
      outline.clear();
      const std::span ids(corners_.data() + begin, sizes_[face]);
      for (const std::uint32_t i : ids) {
        if (i >= mesh_.positions.size())
          throw Error(file_.string() + ": face " + std::to_string(face) + ": vertex index " +
                      std::to_string(i) + " is out of range (" +
                      std::to_string(mesh_.positions.size()) + " vertices)");
        outline.push_back(mesh_.positions[i]);
      }
      for (const auto& t : triangulate_polygon(outline))
        mesh_.triangles.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
    }
  }

  const std::filesystem::path& file_;
  const Header& header_;
  Values values_;
  std::vector<double> row_, list_;
  std::vector<std::uint32_t> sizes_, corners_;  // of the faces
  MeshData mesh_;
};

}  // namespace

void read_ply(Model& model, const std::filesystem::path& file, const ReadOptions& options) {
  ModelBudget budget(model, options);
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  budget.need(bytes.size(), file.string());
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const Header header = HeaderReader(file, text).read();
  MeshData mesh = Reader(file, header, Values(file, text.substr(header.end), header.format)).read();
  if (mesh.triangles.empty()) throw Error(file.string() + ": has no triangles");
  budget.need(bytes_of(mesh), file.string());
  Model::Node node;
  node.name = mesh.name;
  node.mesh = MeshId(model.meshes.size());
  node.material = MaterialId(model.materials.size());
  model.materials.push_back(grey_material(mesh.name));
  model.meshes.push_back(std::move(mesh));
  model.nodes.push_back(std::move(node));
}

}  // namespace atrium::scene
