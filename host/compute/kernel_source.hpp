#pragma once
// Kernel texts: those inside the library, or those of a folder; includes made one text with them.

#include <string>
#include <vector>

namespace earthshine {

struct KernelText {
    const char* name;  ///< file name without a folder, as #include writes it
    const char* text;
};

/// Every .cl, .clh and shared .h of kernels/, closed by {nullptr, nullptr}. Generated (kernels/embed.cmake).
extern const KernelText kKernelTexts[];

/// The text of `file` with its quoted includes put in place, each once, under #line marks that keep file names and line
/// numbers in a compiler's messages. From the library, or from `folder` (itself, common/, shared/) if that is not
/// empty. Throws InputError naming the include that cannot be found.
std::string expandKernel(const std::string& file, const std::string& folder);

/// The same for a text that is not among the library's, `file` being its name in messages; what it includes is.
std::string expandKernelText(const std::string& file, const std::string& text, const std::string& folder);

/// A compiler's log in which "<kernel>:N:", as NVIDIA's driver writes, past the #line marks, for line N of the whole
/// expanded text, is replaced by the file and line there.
std::string withFilesAndLines(const std::string& log, const std::string& expandedText);

/// The argument names of kernel `name` in an expanded text, in order: one for a plain argument, name and nameLayout for
/// a SURFACE_IN or SURFACE_OUT, what RSM_IN stands for with records or with images.
std::vector<std::string> argumentNames(const std::string& expandedText, const std::string& name, bool rsmRecords);

}  // namespace earthshine
