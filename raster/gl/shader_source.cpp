#include "raster/gl/shader_source.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "earthshine/error.hpp"

namespace earthshine::raster {

namespace {

void append(ShaderSource& shader, std::string_view name, const std::string& defines) {
    if (std::find(shader.files.begin(), shader.files.end(), name) != shader.files.end()) return;
    std::string_view rest = findShaderText(name);
    if (rest.empty())
        throw BuildError(fmt::format("raster/shaders/{}: there is no such shader file", name), std::string());
    const std::size_t file = shader.files.size();
    shader.files.emplace_back(name);
    if (file > 0) shader.text += fmt::format("#line 1 {}\n", file);

    for (int line = 1; !rest.empty(); ++line) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view text = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        constexpr std::string_view kInclude = "#include \"";
        if (text.starts_with(kInclude)) {
            append(shader, text.substr(kInclude.size(), text.rfind('"') - kInclude.size()), {});
            shader.text += fmt::format("#line {} {}\n", line + 1, file);
            continue;
        }
        shader.text.append(text).push_back('\n');
        if (text.starts_with("#version") && !defines.empty())
            shader.text += fmt::format("{}#line {} {}\n", defines, line + 1, file);
    }
}

/// Takes a number off the front of `text`.
bool takeNumber(std::string_view& text, std::size_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(std::size_t(end - text.data()));
    return error == std::errc();
}

bool takeChar(std::string_view& text, char wanted) {
    if (!text.starts_with(wanted)) return false;
    text.remove_prefix(1);
    return true;
}

/// One line of a log. Mesa, Intel and AMD write "0:12", NVIDIA "0(12)", at its start or after "ERROR: ".
std::string nameFile(std::string_view line, const std::vector<std::string>& files) {
    const std::string_view prefix = line.substr(0, std::min(line.find_first_of("0123456789"), line.size()));
    std::string_view rest = line.substr(prefix.size());
    std::size_t file = 0;
    std::size_t number = 0;
    const bool isPlace = (prefix.empty() || prefix.ends_with(": ")) && takeNumber(rest, file) && file < files.size() &&
                         (takeChar(rest, ':') ? takeNumber(rest, number)
                                              : takeChar(rest, '(') && takeNumber(rest, number) && takeChar(rest, ')'));
    return isPlace ? fmt::format("{}{}:{}{}", prefix, files[file], number, rest) : std::string(line);
}

}  // namespace

ShaderSource loadShader(std::string_view name, const std::vector<std::string>& defines) {
    std::string defineLines;
    for (const std::string& define : defines) defineLines += fmt::format("#define {}\n", define);
    ShaderSource shader;
    append(shader, name, defineLines);
    return shader;
}

std::string nameFiles(std::string_view log, const std::vector<std::string>& files) {
    std::string result;
    while (!log.empty()) {
        const std::size_t end = std::min(log.find('\n'), log.size() - 1) + 1;
        result += nameFile(log.substr(0, end), files);
        log.remove_prefix(end);
    }
    return result;
}

}  // namespace earthshine::raster
