// SPDX-License-Identifier: BSD-3-Clause
// The plot library of the live page; tools/vendor_page bundles it into viewer/page/vendor/uplot.js.
export {default} from 'uplot';
