#include "web/web_page.h"

#include <zlib.h>

#include <string_view>

#include "material/error.h"

extern "C" const char atrium_walk_page[];
extern "C" const char atrium_walk_page_end[];

namespace atrium::app {

namespace {

std::vector<std::uint8_t> gzip(const std::vector<std::uint8_t>& bytes) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw RuntimeFailure("the scene cannot be packed");
  std::vector<std::uint8_t> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  stream.next_in = const_cast<Bytef*>(bytes.data());  // zlib does not write there
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw RuntimeFailure("the scene cannot be packed");
  return out;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t v = std::uint32_t{bytes[i]} << 16U |
                            (left > 1 ? std::uint32_t{bytes[i + 1]} << 8U : 0U) |
                            (left > 2 ? std::uint32_t{bytes[i + 2]} : 0U);
    text += kDigits[v >> 18U];
    text += kDigits[v >> 12U & 63U];
    text += left > 1 ? kDigits[v >> 6U & 63U] : '=';
    text += left > 2 ? kDigits[v & 63U] : '=';
  }
  return text;
}

std::string html_text(const std::string& plain) {
  std::string text;
  for (const char c : plain) {
    if (c == '&')
      text += "&amp;";
    else if (c == '<')
      text += "&lt;";
    else if (c == '>')
      text += "&gt;";
    else
      text += c;
  }
  return text;
}

}  // namespace

std::vector<std::uint8_t> web_page(const std::vector<std::uint8_t>& glb, const std::string& title) {
  std::string_view rest(atrium_walk_page,
                        static_cast<std::size_t>(atrium_walk_page_end - atrium_walk_page));
  const std::string name = html_text(title);
  const std::string scene = base64(gzip(glb));
  constexpr std::string_view kTitle = "@TITLE@";
  constexpr std::string_view kScene = "@SCENE@";
  std::vector<std::uint8_t> page;
  page.reserve(rest.size() + scene.size() + 2 * name.size());
  const auto append = [&](std::string_view text) {
    page.insert(page.end(), text.begin(), text.end());
  };
  while (!rest.empty()) {
    const std::size_t at = std::min(rest.find(kTitle), rest.find(kScene));
    append(rest.substr(0, at));
    if (at == std::string_view::npos) break;
    append(rest.substr(at).starts_with(kTitle) ? name : scene);
    rest.remove_prefix(at + kTitle.size());  // both are as long
  }
  return page;
}

}  // namespace atrium::app
