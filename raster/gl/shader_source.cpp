#include "raster/gl/shader_source.hpp"

#include <algorithm>
#include <regex>

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

}  // namespace

ShaderSource loadShader(std::string_view name, const std::vector<std::string>& defines) {
    std::string defineLines;
    for (const std::string& define : defines) defineLines += fmt::format("#define {}\n", define);
    ShaderSource shader;
    append(shader, name, defineLines);
    return shader;
}

std::string nameFiles(std::string_view log, const std::vector<std::string>& files) {
    // Mesa, Intel and AMD write "0:12", NVIDIA "0(12)", at the start of a line or after "ERROR: ".
    static const std::regex place(R"((^|\n|: )(\d+)(?::(\d+)|\((\d+)\)))");
    const std::string text(log);
    std::string result;
    auto last = text.cbegin();
    for (std::sregex_iterator it(text.begin(), text.end(), place), end; it != end; ++it) {
        const std::smatch& match = *it;
        const std::string number = match[2].str();
        const std::size_t file = number.size() < 4 ? std::size_t(std::stoi(number)) : files.size();
        result.append(last, match[0].first);
        const std::string line = match[3].matched ? match[3].str() : match[4].str();
        result += file < files.size() ? fmt::format("{}{}:{}", match[1].str(), files[file], line) : match[0].str();
        last = match[0].second;
    }
    result.append(last, text.cend());
    return result;
}

}  // namespace earthshine::raster
