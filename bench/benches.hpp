#pragma once
// The tables: one function a file, each adds its rows.

namespace earthshine::bench {

void addCopyRows();
void addUnpackRows();
void addDirectLightRows();
void addRsmRows();
void addRsmGatherRows();
void addTileAverageRows();
void addTemporalRows();
void addAtrousRows();
void addLowerResolutionRows();
void addDisplayRows();
void addIndirectRows();
void addFrameRows();

}  // namespace earthshine::bench
