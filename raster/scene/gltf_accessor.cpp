#include "raster/scene/gltf_accessor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

namespace earthshine::raster {

namespace {

/// Elements in a buffer: the first byte and the step from one to the next.
struct Elements {
    const unsigned char* data;
    std::size_t stride;
};

template <typename T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);  // glTF aligns it, a file need not
    return value;
}

/// Calls `body` with a value of the C++ type that a component type of indices stands for.
template <typename Body>
void withIndexType(int componentType, const Body& body) {
    if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return body(std::uint8_t());
    if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return body(std::uint16_t());
    return body(std::uint32_t());
}

/// The same for attributes.
template <typename Body>
void withComponentType(int componentType, const Body& body) {
    if (componentType == TINYGLTF_COMPONENT_TYPE_BYTE) return body(std::int8_t());
    if (componentType == TINYGLTF_COMPONENT_TYPE_SHORT) return body(std::int16_t());
    if (componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return body(float());
    return withIndexType(componentType, body);
}

const unsigned char* viewBytes(const GltfContext& context, int view, std::size_t offset) {
    const tinygltf::BufferView& of = context.model.bufferViews[std::size_t(view)];
    return context.model.buffers[std::size_t(of.buffer)].data.data() + of.byteOffset + offset;
}

std::size_t elementBytes(const tinygltf::Accessor& accessor) {
    return std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType))) *
           std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)));
}

/// Calls `store(element, bytes)` for each element that the accessor's own buffer view and then its sparse values give.
/// Elements that neither gives are zero.
template <typename Store>
void forEachElement(const GltfContext& context, int index, const std::string& place, const Store& store) {
    const tinygltf::Accessor& accessor = context.model.accessors[std::size_t(index)];
    const std::size_t bytes = elementBytes(accessor);
    if (accessor.bufferView >= 0) {
        const std::size_t given = context.model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
        const Elements elements{viewBytes(context, accessor.bufferView, accessor.byteOffset), given ? given : bytes};
        for (std::size_t i = 0; i < accessor.count; ++i) store(i, elements.data + i * elements.stride);
    }
    if (!accessor.sparse.isSparse) return;
    const auto& sparse = accessor.sparse;
    const unsigned char* indices =
        viewBytes(context, sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset));
    const unsigned char* values = viewBytes(context, sparse.values.bufferView, std::size_t(sparse.values.byteOffset));
    withIndexType(sparse.indices.componentType, [&](auto zero) {
        using Index = decltype(zero);
        std::size_t next = 0;
        for (std::size_t i = 0; i < std::size_t(sparse.count); ++i) {
            const auto element = std::size_t(load<Index>(indices + i * sizeof(Index)));
            if (element < next || element >= accessor.count) {
                context.file.fail(place, fmt::format("accessors[{}].sparse.indices[{}] is {}, not in [{}; {})", index,
                                                     i, element, next, accessor.count));
            }
            next = element + 1;
            store(element, values + i * bytes);
        }
    });
}

template <typename T>
float toFloat(T value, bool normalized) {
    if constexpr (std::is_floating_point_v<T>) {
        return value;
    } else {
        if (!normalized) return float(value);
        return std::max(float(value) / float(std::numeric_limits<T>::max()), -1.0f);
    }
}

/// Stops a file of few bytes whose accessors are read very often, or stand for very many zeros.
void countElements(const GltfContext& context, int accessor, std::size_t most, const std::string& place) {
    const std::size_t count = context.model.accessors[std::size_t(accessor)].count;
    if (count > most) {
        context.file.fail(place, fmt::format("accessors[{}] has {} elements; {} is the most", accessor, count, most));
    }
    context.elementsRead += count;
    if (context.elementsRead > gltf_limits::kElements) {
        context.file.fail(place,
                          fmt::format("the scene reads more than {} elements of accessors", gltf_limits::kElements));
    }
}

}  // namespace

std::vector<float> readFloats(const GltfContext& context, int accessor, int components, float fill,
                              const std::string& place) {
    const tinygltf::Accessor& of = context.model.accessors[std::size_t(accessor)];
    countElements(context, accessor, gltf_limits::kVertices, place);
    const auto width = std::size_t(components);
    const std::size_t given = std::min(width, std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(of.type))));
    std::vector<float> values(of.count * width, fill);
    for (std::size_t i = 0; i < of.count; ++i) {
        std::fill_n(values.begin() + std::ptrdiff_t(i * width), given, 0.0f);
    }
    withComponentType(of.componentType, [&](auto zero) {
        using T = decltype(zero);
        forEachElement(context, accessor, place, [&](std::size_t element, const unsigned char* bytes) {
            for (std::size_t c = 0; c < given; ++c) {
                const float value = toFloat(load<T>(bytes + c * sizeof(T)), of.normalized);
                if (!std::isfinite(value)) context.file.fail(fmt::format("{}[{}]", place, element), "is not finite");
                values[element * width + c] = value;
            }
        });
    });
    return values;
}

std::vector<std::uint32_t> readIndices(const GltfContext& context, int accessor, std::size_t vertexCount,
                                       const std::string& place) {
    const tinygltf::Accessor& of = context.model.accessors[std::size_t(accessor)];
    countElements(context, accessor, gltf_limits::kIndices, place);
    std::vector<std::uint32_t> values(of.count, 0);
    withIndexType(of.componentType, [&](auto zero) {
        using T = decltype(zero);
        forEachElement(context, accessor, place, [&](std::size_t element, const unsigned char* bytes) {
            values[element] = std::uint32_t(load<T>(bytes));
        });
    });
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] >= vertexCount) {
            context.file.fail(fmt::format("{}[{}]", place, i),
                              fmt::format("is {}, but there are {} vertices", values[i], vertexCount));
        }
    }
    return values;
}

}  // namespace earthshine::raster
