#include "figures/page.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "figures/axes.h"

namespace plab::figures
{
namespace
{

constexpr const char* kStyle = R"(
:root{--ink:#1b1f24;--muted:#5b6570;--line:#dfe3e8;--paper:#fff;--card:#f7f8fa;--link:#0072b2}
@media (prefers-color-scheme:dark){@media screen{:root{--ink:#e8ebee;--muted:#a3adb7;--line:#333b44;--paper:#14181d;--card:#1b2027;--link:#4aa8e0}}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 "Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:980px;margin:0 auto;padding:40px 28px 80px}
h1{font-size:30px;line-height:1.2;margin:0 0 8px;letter-spacing:-.01em}
h2{font-size:20px;margin:44px 0 12px;padding-top:20px;border-top:1px solid var(--line)}
.lead{font-size:17px;color:var(--muted);margin:0 0 8px}
ul.findings{margin:20px 0 0;padding:18px 22px 18px 40px;background:var(--card);border-radius:10px}
ul.findings li{margin:6px 0}
figure{margin:18px 0 30px}
figure svg{width:100%;height:auto;display:block}
figure .narrow svg{width:auto;max-width:100%}
figcaption{color:var(--muted);font-size:14px;margin-top:6px;max-width:76ch}
.scroll{overflow-x:auto;margin:14px 0;width:min(1500px,100vw - 56px);margin-left:calc(50% - min(750px,50vw - 28px))}
.scroll table{width:auto;min-width:min(924px,100%);margin:0 auto}
table{border-collapse:collapse;font-size:13.5px;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:6px 10px;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}
th{cursor:pointer;color:var(--muted);font-weight:600;user-select:none;vertical-align:bottom}
th:hover{color:var(--ink)}
th[aria-sort=ascending]::after{content:" \25B4"}
th[aria-sort=descending]::after{content:" \25BE"}
th:first-child,td:first-child,.text{text-align:left}
td.text{white-space:normal}td.long{min-width:16em}
tbody tr:hover{background:var(--card)}
dl{display:grid;grid-template-columns:max-content 1fr;gap:4px 18px;font-size:14.5px;margin:10px 0}
dt{color:var(--muted)}dd{margin:0}
pre{background:var(--card);padding:12px 16px;border-radius:8px;overflow-x:auto;font-size:13px;white-space:pre-wrap;overflow-wrap:anywhere}
a{color:var(--link)}
@media print{main{padding:0;max-width:none}.scroll{width:auto;margin-left:0}h2{break-after:avoid}figure,tr{break-inside:avoid}table{font-size:8.5px}th,td{padding:2px 4px}}
)";

constexpr const char* kScript = R"(
document.querySelectorAll('table.sortable').forEach(t=>t.querySelectorAll('th').forEach((h,c)=>{
  h.tabIndex=0;
  const sort=()=>{
    const up=h.getAttribute('aria-sort')!=='ascending',b=t.tBodies[0];
    const key=r=>{const d=r.cells[c],k=d.dataset.key??d.textContent,n=parseFloat(k);return k===''?NaN:isNaN(n)||!/^[-+.\d]/.test(k)?k:n};
    const rows=[...b.rows].sort((x,y)=>{
      const a=key(x),z=key(y),na=Number.isNaN(a),nz=Number.isNaN(z);
      if(na||nz)return na-nz;
      const o=typeof a==='number'&&typeof z==='number'?a-z:String(a).localeCompare(String(z));
      return up?o:-o});
    t.querySelectorAll('th').forEach(o=>o.removeAttribute('aria-sort'));
    h.setAttribute('aria-sort',up?'ascending':'descending');
    rows.forEach(r=>b.append(r))};
  h.addEventListener('click',sort);
  h.addEventListener('keydown',e=>{if(e.key==='Enter')sort()})}));
)";

constexpr std::size_t kLongText = 40;  // bytes; longer texts get more room, and are broken into lines

std::string class_of(const PageCell& c)
{
    if (!c.key.empty()) return "";
    return c.text.size() > kLongText ? " class=\"text long\"" : " class=\"text\"";
}

/// `column`: a cell that says whether its column is text or numbers.
std::string cell(const char* tag, const PageCell& c, const PageCell& column)
{
    std::string out = std::string("<") + tag;
    if (!c.key.empty()) out += " data-key=\"" + escape_markup(c.key == "-" ? "" : c.key) + "\"";
    if (!c.hint.empty()) out += " title=\"" + escape_markup(c.hint) + "\"";
    out += class_of(column);
    return out + ">" + escape_markup(c.text) + "</" + tag + ">";
}

}  // namespace

PageCell text_cell(std::string text, std::string hint) { return {std::move(text), "", std::move(hint)}; }

PageCell number_cell(double value, std::string hint)
{
    std::array<char, 40> key{"-"};
    if (std::isfinite(value)) (void)std::snprintf(key.data(), key.size(), "%.9e", value);
    return {short_number(value), key.data(), std::move(hint)};
}

PageCell no_cell(std::string hint) { return {"–", "-", std::move(hint)}; }

std::vector<PageCell> text_cells(std::initializer_list<const char*> texts)
{
    std::vector<PageCell> out;
    for (const char* text : texts) out.push_back(text_cell(text));
    return out;
}

void Page::heading(const std::string& text) { body_ += "<h2>" + escape_markup(text) + "</h2>\n"; }
void Page::paragraph(const std::string& text) { body_ += "<p>" + escape_markup(text) + "</p>\n"; }
void Page::code(const std::string& text) { body_ += "<pre>" + escape_markup(text) + "</pre>\n"; }

void Page::link(const std::string& target, const std::string& text)
{
    body_ += "<p><a href=\"" + escape_markup(target) + "\">" + escape_markup(text) + "</a></p>\n";
}

void Page::list(const std::vector<std::string>& items)
{
    body_ += "<ul class=\"findings\">\n";
    for (const std::string& item : items) body_ += "<li>" + escape_markup(item) + "</li>\n";
    body_ += "</ul>\n";
}

void Page::figure(const Drawing& drawing, const std::string& caption)
{
    // A small picture is not enlarged.
    std::string svg = drawing.svg(false);
    if (drawing.width() < 800) svg.insert(4, " style=\"max-width:" + std::to_string(static_cast<int>(drawing.width() * 1.1)) + "px\"");
    body_ += "<figure>" + svg + "<figcaption>" + escape_markup(caption) + "</figcaption></figure>\n";
}

void Page::table(const std::vector<PageCell>& head, const std::vector<std::vector<PageCell>>& rows)
{
    body_ += "<div class=\"scroll\"><table class=\"sortable\"><thead><tr>";
    static const PageCell nothing{"", "-", ""};
    for (std::size_t i = 0; i < head.size(); ++i)
    {
        const bool is_known = !rows.empty() && i < rows.front().size();
        body_ += cell("th", {head[i].text, "", head[i].hint}, is_known ? PageCell{"", rows.front()[i].key, ""} : nothing);
    }
    body_ += "</tr></thead><tbody>\n";
    for (const auto& row : rows)
    {
        body_ += "<tr>";
        for (const PageCell& c : row) body_ += cell("td", c, c);
        body_ += "</tr>\n";
    }
    body_ += "</tbody></table></div>\n";
}

void Page::facts(const std::vector<std::pair<std::string, std::string>>& facts)
{
    body_ += "<dl>\n";
    for (const auto& [name, text] : facts)
        if (!text.empty()) body_ += "<dt>" + escape_markup(name) + "</dt><dd>" + escape_markup(text) + "</dd>\n";
    body_ += "</dl>\n";
}

std::string Page::html() const
{
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
           "content=\"width=device-width,initial-scale=1\">"
           "<meta name=\"color-scheme\" content=\"light dark\"><title>" +
           escape_markup(title_) + "</title>\n<style>" + kStyle + svg_style() + "</style></head>\n<body><main>\n<h1>" +
           escape_markup(title_) + "</h1>\n<p class=\"lead\">" + escape_markup(lead_) + "</p>\n" + body_ + "</main><script>" + kScript +
           "</script></body></html>\n";
}

}  // namespace plab::figures
