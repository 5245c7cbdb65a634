//! The arena as rules see it. It has no objects yet.
use crate::arena::Arena;
use lang::constraint::*;
impl Scene for Arena {
    fn find(&mut self, _name: &str) -> Option<Object> {
        None
    }
    fn type_of(&mut self, _object: Object) -> Option<&'static str> {
        None
    }
    fn property(&mut self, _object: Object, _chain: &[Box<str>]) -> Result<Value, Missing> {
        Err(Missing::Property(0))
    }
    fn set_property(&mut self, _object: Object, _property: &str, _value: &Value) -> bool {
        false
    }
    fn is_inside(
        &mut self,
        _object: Object,
        _region: Object,
        _point: ObjectPoint,
    ) -> Result<bool, Unfit> {
        Ok(false)
    }
    fn bounding_rect(&mut self, _object: Object) -> Option<Rect> {
        None
    }
}
