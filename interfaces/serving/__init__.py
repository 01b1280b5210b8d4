"""The process of a component: orders, substeps, interpolation of inputs, sums of impulses."""
