#include "scene/checkpoint_io.h"

#include <cstring>
#include <fstream>
#include <limits>
#include <span>

#include "hash64.h"
#include "import_util.h"
#include "material/error.h"
#include "scene/archive.h"
#include "scene/output_file.h"

namespace atrium::scene {
namespace fs = std::filesystem;

namespace {

constexpr char kMagic[8] = {'A', 'T', 'R', 'I', 'U', 'M', 'C', 'P'};
constexpr std::uint32_t kVersion = 1;

std::uint64_t checksum(const char* data, std::size_t size) {
  Hash64 h;
  h.bytes(data, size);
  return h.result();
}

void entries(ArchiveWriter& a, const Checkpoint& c) {
  a(static_cast<std::uint64_t>(c.made_with.size()));
  for (const auto& [name, value] : c.made_with) {
    a(name);
    a(value);
  }
}
void entries(ArchiveReader& a, Checkpoint& c) {
  c.made_with.resize(a.count(2 * sizeof(std::uint64_t)));
  for (auto& [name, value] : c.made_with) {
    a(name);
    a(value);
  }
}

}  // namespace

void write_checkpoint(const Checkpoint& c, const fs::path& file) {
  ArchiveWriter w;
  w.raw(kMagic, sizeof kMagic);
  w(kVersion);
  w(c.scene_hash);
  entries(w, c);
  w(c.state);
  w(checksum(w.bytes.data(), w.bytes.size()));
  OutputFile output(file);
  std::ofstream out(output.path(), std::ios::binary);
  out.write(w.bytes.data(), static_cast<std::streamsize>(w.bytes.size()));
  out.close();
  if (!out) throw RuntimeFailure(file.string() + ": writing failed");
  output.commit();
}

Checkpoint read_checkpoint(const fs::path& file) {
  const std::string name = file.string();
  const std::vector<std::uint8_t> whole =
      read_file_bytes(file, std::numeric_limits<std::uintmax_t>::max());
  const std::span bytes(reinterpret_cast<const char*>(whole.data()), whole.size());
  constexpr std::size_t kHead = sizeof kMagic + sizeof kVersion;
  if (bytes.size() < kHead || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    throw Error(name + ": is no checkpoint of a picture");
  std::uint32_t version = 0;
  std::memcpy(&version, bytes.data() + sizeof kMagic, sizeof version);
  if (version != kVersion)
    throw Error(name + ": has version " + std::to_string(version) + ", this program reads " +
                std::to_string(kVersion));
  std::uint64_t sum = 0;
  if (bytes.size() < kHead + sizeof sum) throw Error(name + ": is truncated or damaged");
  const std::size_t size = bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + size, sizeof sum);
  if (sum != checksum(bytes.data(), size)) throw Error(name + ": is truncated or damaged");
  ArchiveReader r(bytes.data() + kHead, bytes.data() + size, name);
  Checkpoint c;
  r(c.scene_hash);
  entries(r, c);
  r(c.state);
  return c;
}

void check_checkpoint(const Checkpoint& kept, const Checkpoint& now, const std::string& file) {
  for (std::size_t i = 0; i < std::max(kept.made_with.size(), now.made_with.size()); ++i) {
    if (i >= kept.made_with.size() || i >= now.made_with.size() ||
        kept.made_with[i].first != now.made_with[i].first)
      throw Error(file + ": was written by another version of this program");
    const auto& [name, value] = kept.made_with[i];
    if (value != now.made_with[i].second)
      throw Error(file + ": its picture has another " + name + " (" + value + ", not " +
                  now.made_with[i].second + ")");
  }
  if (kept.scene_hash != now.scene_hash) throw Error(file + ": its picture is of another scene");
}

}  // namespace atrium::scene
