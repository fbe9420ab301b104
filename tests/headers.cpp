// SPDX-License-Identifier: Apache-2.0
// The library of headers.hpp, which needs a source.
