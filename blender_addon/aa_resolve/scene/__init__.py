# SPDX-License-Identifier: GPL-3.0-or-later
"""The open scene as an export needs it: read, brought to the light model, moved and rendered. Knows no passes."""
