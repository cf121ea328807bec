#pragma once
// The tuning table: rows of text that say which lanes, storage and work-groups a device gets. `earthshine_bench --tune`
// writes such rows, the library holds some (kShippedTuning), and a user may have a file of them.
//
//   # scope    pattern        kernel       lanes   storage  group
//   type       CPU            *            native  planar   64x4
//   device     "llvmpipe"     rsm_gather   -       -        16x4
//
// scope    device, platform, vendor (a part of that name, in any case), type (GPU, CPU, accelerator, other), default
// kernel   a kernel's name, or * for all. Only rows of all kernels have lanes and storage
// lanes    1, 4, 8, 16; native: the device's float width, from 4 to 16
// storage  image, planar, packed
// group    work-items a group, x by y
// - leaves a value to a row further down this order: device, platform, vendor, type, default; within one scope a
// kernel's own row before *, then the order of the text. A user's rows go before all of the library's.

#include <iosfwd>
#include <string>
#include <vector>

#include "earthshine/device.hpp"

namespace earthshine {

enum class TuningScope { Device, Platform, Vendor, Type, Default };

struct TuningRow {
    TuningScope scope = TuningScope::Default;
    std::string pattern;          ///< "" in the scope Default
    std::string kernel;           ///< "" = all
    int lanes = 0;                ///< 0 = left open, kNativeLanes = the device's width
    std::string storage;          ///< "" = left open
    int localSizePx[2] = {0, 0};  ///< 0 = left open
    std::string source;           ///< of the text: "shipped table", or a file's name

    static constexpr int kNativeLanes = -1;
};

/// The rows that the library holds (tuning_table.cpp).
extern const char kShippedTuning[];

/// Reads rows, and puts them in the order in which they are asked. Throws InputError "SOURCE:LINE: ..." for what is no
/// row.
std::vector<TuningRow> parseTuning(std::istream& lines, const std::string& source);

/// A user's rows from `file` ("" = $EARTHSHINE_TUNING, or none), then the shipped ones: the order in which they are
/// asked. Throws InputError if the file cannot be read, or holds what is no row.
std::vector<TuningRow> tuningRows(const std::string& file);

/// What rows say of a device, the first that fits going first; values that no row has keep Tuning's own. `reason` names
/// the row that gave the storage.
Tuning lookUpTuning(const std::vector<TuningRow>& rows, const DeviceCaps& caps);

/// One line of the table, as parseTuning reads it.
std::string formatTuningRow(const TuningRow& row);
/// The comment that names the columns.
std::string tuningHeading();

}  // namespace earthshine
