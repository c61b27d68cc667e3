// The page: the template, with a manifest and the arrays that it refers to in the place that the template keeps for
// them.
#include <certa/error.h>
#include <certa/view.h>

#include "page/describe_model.h"
#include "page/json_text.h"
#include "page/template.h"

namespace certa {
namespace {

std::string title_of(std::span<const ViewModel> models) {
    std::string title;
    for (const ViewModel& model : models.first(std::min<std::size_t>(3, models.size())))
        title.append(title.empty() ? "" : ", ").append(model.name);
    return models.size() > 3 ? title + ", ..." : title;
}

}  // namespace

std::string format_view(std::span<const ViewModel> models, const ViewOptions& options) {
    if (models.empty()) throw InputError({{DefectKind::empty_input, {}, {}, "a page needs at least one model"}});
    page::PageArrays arrays;
    std::vector<std::string> entries;
    for (const ViewModel& model : models) entries.push_back(page::describe_model(model, arrays));
    const std::string manifest =
        page::JsonObject()
            .set("title", page::json_string(options.title.empty() ? title_of(models) : options.title))
            .set("up", options.up == UpAxis::y ? "\"y\"" : "\"z\"")
            .set("models", page::json_list(entries))
            .text();
    const std::string_view text = page::page_template();
    const std::size_t place = text.find(page::data_place);
    std::string result(text.substr(0, place));
    result.append("<script type=\"application/json\" id=\"certa-manifest\">").append(manifest).append("</script>\n");
    result.append(arrays.elements()).append(text.substr(place + page::data_place.size()));
    return result;
}

}  // namespace certa
