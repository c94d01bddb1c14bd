"""The parts of the batch that need Blender, as a program or as `bpy`: .blend, FBX, Smart UV Project and renders.

Only the worker's task imports these modules, and only for assets or settings that need them.
"""
