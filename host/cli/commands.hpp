#pragma once
// The subcommands. Each adds its name, its options and what it does; main.cpp knows nothing else of them.

#include "cli/options.hpp"

namespace earthshine::cli {

void addDevices(Options& program);
void addRender(Options& program);
void addIndirect(Options& program);
void addReference(Options& program);
void addCompare(Options& program);
void addQuality(Options& program);
void addMotion(Options& program);

}  // namespace earthshine::cli
