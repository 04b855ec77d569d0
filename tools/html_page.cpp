#include "tools/html_page.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

constexpr std::string_view kStyle = R"css(
:root{--page:#f5f4f1;--card:#fff;--text:#22211e;--soft:#6d6a63;--line:#dddad2;--accent:#2b6cb0;--good:#1f7a54;--bad:#b3261e;color-scheme:light dark}
@media (prefers-color-scheme:dark){:root{--page:#191918;--card:#232321;--text:#e9e7e1;--soft:#a29f97;--line:#3b3a36;--accent:#7db4ea;--good:#5cc497;--bad:#f0776c}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--text);font:15px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:1120px;margin:0 auto;padding:20px 16px 48px}
h1{font-size:24px;line-height:1.25;margin:8px 0 2px;overflow-wrap:anywhere}
h2{font-size:17px;margin:0 0 10px}
.soft{color:var(--soft);margin:0 0 18px;overflow-wrap:anywhere}
section{background:var(--card);border:1px solid var(--line);border-radius:10px;padding:16px;margin:0 0 16px}
.tiles{display:grid;grid-template-columns:repeat(auto-fill,minmax(148px,1fr));gap:10px;margin:0 0 16px}
.tile{background:var(--card);border:1px solid var(--line);border-radius:10px;padding:10px 14px}
.tile b{display:block;font-size:22px;line-height:1.3;font-weight:650;font-variant-numeric:tabular-nums;white-space:nowrap}
.tile span{color:var(--soft);font-size:13px}
.tile.good b,.good{color:var(--good)}
.tile.bad b,.bad{color:var(--bad)}
.scroll{overflow-x:auto}
.scroll svg{display:block;width:100%;height:auto;min-width:560px}
.map svg{border-radius:6px}
.chart{fill:currentColor;font-size:12px}
.chart text{fill:var(--soft)}
.chart .strip{fill:var(--text);font-size:13px}
.chart .grid{stroke:var(--line);fill:none}
.chart .line{stroke:var(--accent);stroke-width:1.3;fill:none;stroke-linejoin:round}
.chart .bars{fill:var(--accent);fill-opacity:.75}
.chart .p50,.chart .p99,.chart .max{stroke-width:2;fill:none}
.chart .p50{stroke:var(--good)}
.chart .p99{stroke:#d98a1f}
.chart .max{stroke:var(--bad)}
.key{display:flex;flex-wrap:wrap;gap:4px 16px;margin:0 0 8px;color:var(--soft);font-size:13px}
.key i{display:inline-block;width:12px;height:12px;border-radius:3px;margin-right:6px;vertical-align:-1px}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:4px 14px 4px 0;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
th{color:var(--soft);font-weight:500}
th:first-child,td:first-child{text-align:left}
pre{margin:8px 0 0;white-space:pre-wrap;overflow-wrap:anywhere;font:12.5px/1.45 ui-monospace,"DejaVu Sans Mono",monospace}
summary{cursor:pointer}
.pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:12px}
figure{margin:0}
figure img{display:block;width:100%;height:auto;border-radius:6px;margin:0 0 6px}
figcaption{color:var(--soft);font-size:13px}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(260px,1fr));gap:0 32px}
)css";

}  // namespace

std::string html_of(std::string_view text) {
  std::string safe;
  for (const char character : text) {
    switch (character) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += character;
    }
  }
  return safe;
}

std::string html_head(std::string_view title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"/>\n"
      "<title>landfix: {0}</title>\n<style>{1}</style></head>\n<body><main>\n<h1>{0}</h1>\n",
      html_of(title), kStyle);
}

std::string tile(const std::string& value, std::string_view what, Mood mood) {
  constexpr std::array<std::string_view, 3> kClasses{"", " good", " bad"};
  return fmt::format("<div class=\"tile{}\"><b>{}</b><span>{}</span></div>\n",
                     kClasses[static_cast<std::size_t>(mood)], value, what);
}

}  // namespace landfix::tools
