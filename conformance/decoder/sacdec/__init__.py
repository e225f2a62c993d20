# SPDX-License-Identifier: Apache-2.0
"""A decoder of sac streams that was written from spec.md alone, to be read beside it. Slow and plain."""
